#include "formats/image/exr_standard.h"

#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfStandardAttributes.h>

#include <algorithm>
#include <cmath>

namespace bnvpl {
namespace {

Imath::M44f matrixOf(const std::array<float, 16>& rows) {
  Imath::M44f matrix;
  std::copy(rows.begin(), rows.end(), matrix.getValue());
  return matrix;
}

std::array<float, 16> rowsOf(const Imath::M44f& matrix) {
  std::array<float, 16> rows{};
  std::copy_n(matrix.getValue(), rows.size(), rows.begin());
  return rows;
}

bool isFinite(const ImageCamera& camera) {
  const auto finite = [](const auto& values) {
    return std::ranges::all_of(values, [](float v) { return std::isfinite(v); });
  };
  return finite(camera.worldToCamera) && finite(camera.worldToNdc) &&
         finite(camera.screenWindowCenter) && std::isfinite(camera.screenWindowWidth);
}

}  // namespace

Imf::Header standardHeader(const Image& image) {
  const PixelBox box = dataWindowOf(image);
  const ImageCamera camera = image.camera.value_or(ImageCamera{});
  constexpr float kSquarePixels = 1.0f;
  Imf::Header header({{0, 0}, {image.width - 1, image.height - 1}},
                     {{box.x0, box.y0}, {box.x1 - 1, box.y1 - 1}}, kSquarePixels,
                     {camera.screenWindowCenter[0], camera.screenWindowCenter[1]},
                     camera.screenWindowWidth);
  Imf::addChromaticities(header, Imf::Chromaticities());
  if (image.camera) {
    Imf::addWorldToCamera(header, matrixOf(camera.worldToCamera));
    Imf::addWorldToNDC(header, matrixOf(camera.worldToNdc));
  }
  return header;
}

void readStandard(const Imf::Header& header, Image& image) {
  const Imath::Box2i &display = header.displayWindow(), &data = header.dataWindow();
  const PixelBox all{0, 0, image.width, image.height};
  const auto from = [](int low, int origin) { return std::max(0, low - origin); };
  const auto to = [](int high, int origin, int size) { return std::min(size, high - origin + 1); };
  const PixelBox box{from(data.min.x, display.min.x), from(data.min.y, display.min.y),
                     to(data.max.x, display.min.x, image.width),
                     to(data.max.y, display.min.y, image.height)};
  if (box != all && box.x0 < box.x1 && box.y0 < box.y1) image.dataWindow = box;
  if (Imf::hasChromaticities(header)) {
    const Imf::Chromaticities& c = Imf::chromaticities(header);
    image.chromaticities = {c.red.x,  c.red.y,  c.green.x, c.green.y,
                            c.blue.x, c.blue.y, c.white.x, c.white.y};
  }
  const auto* worldToCamera = header.findTypedAttribute<Imf::M44fAttribute>("worldToCamera");
  const auto* worldToNdc = header.findTypedAttribute<Imf::M44fAttribute>("worldToNDC");
  if (!worldToCamera || !worldToNdc) return;
  const Imath::V2f centre = header.screenWindowCenter();
  const ImageCamera camera{rowsOf(worldToCamera->value()),
                           rowsOf(worldToNdc->value()),
                           header.screenWindowWidth(),
                           {centre.x, centre.y}};
  if (isFinite(camera)) image.camera = camera;
}

}  // namespace bnvpl
