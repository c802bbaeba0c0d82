#include "tools/render/preview_outputs.h"

namespace bnvpl {

FilmPreview previewTo(const ImagePaths& paths, const Values& options, LiveViewer* viewer) {
  FilmPreview preview;
  if (viewer) {
    preview.tile = [viewer](const PixelBox& box, std::span<const Vec3> radiance) {
      viewer->show(box, radiance);
    };
  }
  const fs::path png = budgetOf(options) ? paths.png : fs::path();
  if (!viewer && png.empty()) return preview;
  preview.image = [viewer, png, &options](const Image& image) {
    if (viewer) viewer->show(image);
    if (!png.empty()) writePng(png, image, options);
  };
  return preview;
}

void showFinished(LiveViewer& viewer, const ViewerAddress& address, const Image& image,
                  Summary& summary) {
  viewer.show(image);
  const uint64_t blocks = viewer.finish();
  const std::string at = address.host + ":" + std::to_string(address.port);
  summary.add("preview_blocks", blocks,
              blocks > 0
                  ? "shown by the viewer at " + at + " in " + std::to_string(blocks) + " updates"
                  : "no viewer was at " + at + "; start tev there to see the image come");
}

}  // namespace bnvpl
