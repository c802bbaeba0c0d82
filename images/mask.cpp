#include "images/mask.h"

#include "core/files.h"
#include "formats/image/pixels_io.h"

namespace bnvpl {
namespace {

Pixels readPng(const fs::path& file) {
  if (!isRegularFile(file)) {
    throw InputError(file, "cannot be read; name a PNG of the image's size for --mask");
  }
  try {
    Pixels pixels = decodePng(file, readBytes(file));
    if (pixels.damage.empty()) return pixels;
  } catch (const InputError&) {
  }
  throw InputError(file, "is no readable PNG; --mask takes a PNG of greys");
}

// The grey of a pixel with 1 to 4 channels: grey, grey alpha, R G B, R G B alpha.
double weightOf(const fs::path& file, const uint8_t* pixel, uint32_t channels, size_t x, size_t y) {
  const auto where = [&] {
    return "pixel (" + std::to_string(x) + ", " + std::to_string(y) + ") is ";
  };
  if (channels >= 3 && (pixel[0] != pixel[1] || pixel[0] != pixel[2])) {
    throw InputError(file, where() + "coloured; a mask is white, black or grey");
  }
  if (channels % 2 == 0 && pixel[channels - 1] != 255) {
    throw InputError(file, where() + "transparent; paint what does not count black");
  }
  return pixel[0] / 255.0;
}

}  // namespace

double Mask::sum(size_t pixels) const {
  if (weights.empty()) return double(pixels);
  double total = 0.0;
  for (const double w : weights) total += w;
  return total;
}

Mask readMask(const fs::path& file, const fs::path& image, const Layer& layer) {
  const Pixels pixels = readPng(file);
  const size_t columns = static_cast<size_t>(layer.width), rows = static_cast<size_t>(layer.height);
  if (pixels.width != columns || pixels.height != rows) {
    throw InputError(file, std::to_string(pixels.width) + " x " + std::to_string(pixels.height) +
                               " pixels, but " + image.string() + " has " +
                               std::to_string(layer.width) + " x " + std::to_string(layer.height) +
                               "; draw the mask at the image's size");
  }
  Mask mask;
  const size_t count = columns * rows;
  mask.weights.resize(count);
  for (size_t i = 0; i < count; ++i) {
    mask.weights[i] = weightOf(file, &pixels.values[i * pixels.channels], pixels.channels,
                               i % columns, i / columns);
  }
  if (mask.sum(count) == 0.0) {
    throw InputError(file, "is black all over; paint what counts white");
  }
  return mask;
}

double weightedMean(const std::vector<float>& values, const Mask& mask) {
  double sum = 0.0;
  for (size_t i = 0; i < values.size(); ++i) sum += mask[i] * double{values[i]};
  return sum / mask.sum(values.size());
}

}  // namespace bnvpl
