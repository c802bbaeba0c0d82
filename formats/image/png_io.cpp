#include "formats/image/png_io.h"

#include "core/checked_malloc.h"

#define STBIW_MALLOC(bytes) bnvpl::mallocOrThrow(bytes)
#define STBIW_REALLOC(old, bytes) bnvpl::reallocOrThrow(old, bytes)
#define STBIW_FREE(memory) std::free(memory)
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb/stb_image_write.h>

#include <limits>
#include <string>

namespace bnvpl {
namespace {

constexpr int kMaxPngSide = 1 << 16;
constexpr size_t kMaxBytes = std::numeric_limits<int>::max();  // in which stb counts them

void appendBytes(void* to, void* bytes, int count) {
  static_cast<std::string*>(to)->append(static_cast<const char*>(bytes),
                                        static_cast<size_t>(count));
}

}  // namespace

void writePng(AtomicFile& file, int width, int height, std::span<const uint8_t> rgb8,
              int channels) {
  if (width < 1 || height < 1 || width > kMaxPngSide || height > kMaxPngSide ||
      rgb8.size() != static_cast<size_t>(channels) * static_cast<size_t>(width) *
                         static_cast<size_t>(height) ||
      rgb8.size() + static_cast<size_t>(height) > kMaxBytes) {
    throw OutputError(file.target(), "a PNG of " + std::to_string(width) + " x " +
                                         std::to_string(height) + " pixels from " +
                                         std::to_string(rgb8.size()) + " bytes cannot be written");
  }
  std::string png;
  if (!stbi_write_png_to_func(appendBytes, &png, width, height, channels, rgb8.data(),
                              channels * width)) {
    throw OutputError(file.target(), "the PNG could not be compressed");
  }
  file.write(png);
}

void writePng(const fs::path& file, int width, int height, std::span<const uint8_t> rgb8) {
  AtomicFile out(file);
  writePng(out, width, height, rgb8);
  out.commit();
}

}  // namespace bnvpl
