#include "formats/pixels_io.h"

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <memory>

#include "core/files.h"
#include "formats/jpeg_guard.h"
#include "formats/png_palette.h"

namespace bnvpl {
namespace {

// Max size of one allocation by stb. A PNG may claim a chunk of 1 GiB, or inflate to more than its
// image.
thread_local size_t mostStbBytes = 0;

// Returns zeroed memory, because a JPEG can use tables that it never defines.
void* stbAllocate(size_t bytes) { return bytes > mostStbBytes ? nullptr : std::calloc(1, bytes); }
void* stbReallocate(void* memory, size_t bytes) {
  return bytes > mostStbBytes ? nullptr : std::realloc(memory, bytes);
}

}  // namespace
}  // namespace bnvpl

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_ONLY_TGA
#define STBI_ONLY_BMP
#define STBI_NO_STDIO
#define STBI_NO_LINEAR
#define STBI_MAX_DIMENSIONS 32768
#define STBI_MALLOC(bytes) bnvpl::stbAllocate(bytes)
#define STBI_REALLOC(memory, bytes) bnvpl::stbReallocate(memory, bytes)
#define STBI_FREE(memory) std::free(memory)
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

namespace bnvpl {
namespace {

// Deflate expands a byte to at most 1032, and a byte of a PNG has at most 8 pixels.
constexpr size_t kMaxPixelsPerByte = size_t{1032} * 8;
constexpr size_t kMaxPixels = size_t{1} << 28;
constexpr size_t kMaxBytes = size_t{1} << 30;  // stb counts bytes in an int

struct FreePixels {
  void operator()(void* pixels) const { stbi_image_free(pixels); }
};

}  // namespace

Pixels decodePixels(const fs::path& file, const std::string& content, int channels) {
  const auto fail = [&](const char* why) {
    return InputError(file, std::string("cannot read the image: ") + (why ? why : "damaged") +
                                "; supply a PNG, JPEG, TGA or BMP file");
  };
  if (content.size() > kMaxBytes) throw fail("larger than 1 GiB");
  const std::string bytes = withWholePalette(content);
  if (!isHarmlessJpeg(bytes)) throw fail("damaged");
  const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
  const int size = static_cast<int>(bytes.size());
  int width = 0, height = 0, own = 0;
  mostStbBytes = size_t{1} << 20;
  if (!stbi_info_from_memory(data, size, &width, &height, &own)) throw fail(stbi_failure_reason());
  const size_t count = static_cast<size_t>(width) * static_cast<size_t>(height);
  if (width < 1 || height < 1 || count > kMaxPixels || count / kMaxPixelsPerByte > bytes.size()) {
    throw fail("it claims more pixels than a file of its size can hold");
  }
  // 16-bit RGBA has 8 bytes per pixel, JPEGs are padded to blocks, and buffers grow by doubling.
  mostStbBytes += 4 * bytes.size() + 32 * count + 256 * static_cast<size_t>(width + height);
  int w = 0, h = 0;
  const std::unique_ptr<stbi_uc, FreePixels> pixels(
      stbi_load_from_memory(data, size, &w, &h, &own, channels));
  if (!pixels || w != width || h != height) throw fail(stbi_failure_reason());
  const auto kept = static_cast<uint32_t>(channels == 0 ? own : channels);
  return {static_cast<uint32_t>(width), static_cast<uint32_t>(height), kept,
          std::vector<uint8_t>(pixels.get(), pixels.get() + count * kept)};
}

std::string readBytes(const fs::path& file) {
  if (!isRegularFile(file)) throw InputError(file, "no such image; check the name");
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace bnvpl
