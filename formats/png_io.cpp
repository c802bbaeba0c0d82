#include "formats/png_io.h"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb/stb_image_write.h>

#include <string>

#include "formats/atomic_file.h"

namespace bnvpl {
namespace {

constexpr int kMaxSide = 1 << 14;  // stb counts the bytes of an image in an int

void appendBytes(void* to, void* bytes, int count) {
  static_cast<std::string*>(to)->append(static_cast<const char*>(bytes),
                                        static_cast<size_t>(count));
}

}  // namespace

void writePng(const fs::path& file, int width, int height, std::span<const uint8_t> rgb8) {
  if (width < 1 || height < 1 || width > kMaxSide || height > kMaxSide ||
      rgb8.size() != 3 * static_cast<size_t>(width) * static_cast<size_t>(height)) {
    throw OutputError(file, "a PNG of " + std::to_string(width) + " x " + std::to_string(height) +
                                " pixels from " + std::to_string(rgb8.size()) +
                                " bytes cannot be written");
  }
  std::string png;
  if (!stbi_write_png_to_func(appendBytes, &png, width, height, 3, rgb8.data(), 3 * width)) {
    throw OutputError(file, "the PNG could not be compressed");
  }
  writeFileAtomically(file, png);
}

}  // namespace bnvpl
