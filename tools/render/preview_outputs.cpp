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
  const uint64_t blocks = viewer_->finish();
  const std::string at = addressText(*address_);
  summary.add("preview_blocks", blocks,
              blocks > 0
                  ? "shown by the viewer at " + at + " in " + std::to_string(blocks) + " updates"
                  : "no viewer was at " + at + "; start tev there to see the image come");
}

}  // namespace bnvpl
