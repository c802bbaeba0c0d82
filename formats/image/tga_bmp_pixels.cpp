// Reads TGA and BMP by stb_image, which trusts its input: formats/image/raster_check.h guards it.
#include <cstdlib>
#include <memory>

#include "formats/image/pixel_readers.h"
#include "formats/image/raster_check.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_TGA
#define STBI_ONLY_BMP
#define STBI_NO_STDIO
#define STBI_NO_LINEAR
#define STBI_MAX_DIMENSIONS 32768
// Zeroed memory: rows that a TGA lacks are not written.
#define STBI_MALLOC(bytes) std::calloc(1, bytes)
#define STBI_REALLOC(memory, bytes) std::realloc(memory, bytes)
#define STBI_FREE(memory) std::free(memory)
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

namespace bnvpl {
namespace {

struct FreePixels {
  void operator()(void* pixels) const { stbi_image_free(pixels); }
};

[[noreturn]] void fail() {
  const char* why = stbi_failure_reason();
  throw PixelError(why && *why ? why : "damaged or cut short");
}

}  // namespace

Pixels readTgaOrBmp(const std::string& bytes) {
  constexpr int kChannels = 4;
  const std::string whole = withWholePalette(bytes);
  const auto* data = reinterpret_cast<const stbi_uc*>(whole.data());
  const int size = static_cast<int>(whole.size());
  int width = 0, height = 0, own = 0;
  if (!stbi_info_from_memory(data, size, &width, &height, &own)) fail();
  // A BMP with rows from the top has a negative height.
  const int64_t rows = std::abs(int64_t{height});
  requirePlausible(width, rows, bytes.size());
  int w = 0, h = 0;
  const std::unique_ptr<stbi_uc, FreePixels> pixels(
      stbi_load_from_memory(data, size, &w, &h, &own, kChannels));
  if (!pixels || w != width || h != rows) fail();
  const size_t count = static_cast<size_t>(w) * static_cast<size_t>(h) * kChannels;
  return {static_cast<uint32_t>(w), static_cast<uint32_t>(h), kChannels,
          std::vector<uint8_t>(pixels.get(), pixels.get() + count),
          lacksPixels(bytes) ? "the file ends before its last row" : ""};
}

}  // namespace bnvpl
