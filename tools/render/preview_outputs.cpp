#include "tools/render/preview_outputs.h"

namespace bnvpl {

Previews::Previews(const std::string& viewer) {
  if (!viewer.empty()) address_ = parseViewerAddress(viewer);
}

FilmPreview Previews::begin(const ImagePaths& paths, const Values& options, const Film& film) {
  FilmPreview preview;
  if (address_) {
    viewer_.emplace(*address_, paths.exr.string(), film.width, film.height);
    preview.tile = [this](const PixelBox& box, std::span<const Vec3> radiance) {
      viewer_->show(box, radiance);
    };
  }
  const fs::path png = budgetOf(options) ? paths.png : fs::path();
  if (!viewer_ && png.empty()) return preview;
  preview.image = [this, png, &options](const Image& image) {
    if (viewer_) viewer_->show(image);
    if (!png.empty()) renewPreview(png, image, options);
  };
  return preview;
}

void Previews::finish(const Image& image, Summary& summary) {
  if (!viewer_) return;
  viewer_->show(image);
  const LiveViewer::Sent sent = viewer_->finish();
  const std::string at = addressText(*address_), updates = std::to_string(sent.blocks) + " updates";
  summary.add("preview_blocks", sent.blocks,
              sent.whole ? "shown by the viewer at " + at + " in " + updates
              : sent.blocks > 0
                  ? "the viewer at " + at + " took " + updates +
                        ", but not the whole image; start it again, or open the file"
                  : "no viewer was at " + at + "; start tev there to see the image come");
  summary.add("preview_whole", sent.whole);
}

}  // namespace bnvpl
