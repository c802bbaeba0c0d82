#include "tools/inspect/mask.h"

#include <fstream>
#include <iterator>
#include <memory>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC  // the scene's textures have their own copy
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#define STBI_MAX_DIMENSIONS 16384
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

namespace bnvpl {
namespace {

struct FreePixels {
  void operator()(stbi_uc* pixels) const { stbi_image_free(pixels); }
};

std::string readBytes(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in || fs::is_directory(file)) {
    throw InputError(file, "cannot be read; name a PNG of the image's size for --mask");
  }
  return {std::istreambuf_iterator<char>(in), {}};
}

// The grey of a pixel with 1 to 4 channels: grey, grey alpha, R G B, R G B alpha.
double weightOf(const fs::path& file, const stbi_uc* pixel, int channels, size_t x, size_t y) {
  const std::string where = "pixel (" + std::to_string(x) + ", " + std::to_string(y) + ") is ";
  if (channels >= 3 && (pixel[0] != pixel[1] || pixel[0] != pixel[2])) {
    throw InputError(file, where + "coloured; a mask is white, black or grey");
  }
  if (channels % 2 == 0 && pixel[channels - 1] != 255) {
    throw InputError(file, where + "transparent; paint what does not count black");
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
  const std::string bytes = readBytes(file);
  int width = 0, height = 0, channels = 0;
  const std::unique_ptr<stbi_uc, FreePixels> pixels(
      bytes.size() > 1u << 30  // stb counts bytes in an int
          ? nullptr
          : stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(bytes.data()),
                                  static_cast<int>(bytes.size()), &width, &height, &channels, 0));
  if (!pixels) throw InputError(file, "is no readable PNG; --mask takes a PNG of greys");
  if (width != layer.width || height != layer.height) {
    throw InputError(file, std::to_string(width) + " x " + std::to_string(height) +
                               " pixels, but " + image.string() + " has " +
                               std::to_string(layer.width) + " x " + std::to_string(layer.height) +
                               "; draw the mask at the image's size");
  }
  Mask mask;
  const size_t columns = static_cast<size_t>(width), count = columns * static_cast<size_t>(height);
  mask.weights.resize(count);
  for (size_t i = 0; i < count; ++i) {
    mask.weights[i] = weightOf(file, pixels.get() + i * static_cast<size_t>(channels), channels,
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
