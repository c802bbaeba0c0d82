#include "formats/image/pixels_io.h"

#include "core/files.h"
#include "core/read_file.h"
#include "formats/image/pixel_readers.h"

namespace bnvpl {
namespace {

// Deflate expands a byte to at most 1032, and a byte of a PNG has at most 8 pixels.
constexpr size_t kMaxPixelsPerByte = size_t{1032} * 8;
constexpr size_t kMaxPixels = size_t{1} << 28;
constexpr size_t kMaxBytes = size_t{1} << 30;  // stb_image counts bytes in an int

template <typename Read>
Pixels decode(const fs::path& file, const std::string& bytes, const std::string& cure,
              const Read& read) {
  try {
    if (bytes.size() > kMaxBytes) throw PixelError("larger than 1 GiB");
    return read();
  } catch (const PixelError& e) {
    throw InputError(file, std::string("cannot read the image: ") + e.what() + "; " + cure);
  }
}

}  // namespace

void requirePlausible(int64_t width, int64_t height, size_t bytes) {
  const bool sides = width >= 1 && height >= 1 && width <= kMaxImageSide && height <= kMaxImageSide;
  const size_t count = sides ? static_cast<size_t>(width) * static_cast<size_t>(height) : 0;
  if (!sides || count > kMaxPixels || count / kMaxPixelsPerByte > bytes)
    throw PixelError("it claims more pixels than a file of its size can hold");
}

Pixels decodePixels(const fs::path& file, const std::string& bytes, const char* others) {
  const std::string cure = std::string("supply a PNG, JPEG, ") + others + "TGA or BMP file";
  return decode(file, bytes, cure, [&] {
    if (isPng(bytes)) return readPng(bytes, true);
    return isJpeg(bytes) ? readJpeg(bytes) : readTgaOrBmp(bytes);
  });
}

Pixels decodePng(const fs::path& file, const std::string& bytes) {
  return decode(file, bytes, "supply a PNG file", [&] {
    if (!isPng(bytes)) throw PixelError("it is no PNG");
    return readPng(bytes, false);
  });
}

std::string readBytes(const fs::path& file) {
  if (!isRegularFile(file))
    throw InputError(file, whyUnreadable(file, "image") + "; check the name");
  return readText(file);
}

}  // namespace bnvpl
