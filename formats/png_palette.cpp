#include "formats/png_palette.h"

#include <cstdint>
#include <string_view>

namespace bnvpl {

namespace {

constexpr std::string_view kSignature("\x89PNG\r\n\x1a\n", 8);
// Offsets in IHDR, which is the first chunk (PNG 1.2, section 11.2.2).
constexpr size_t kBitDepth = 24, kColourType = 25, kFirstChunk = 8, kIndexed = 3;
constexpr size_t kChunkFrame = 12;  // length, type and checksum

uint32_t bigEndian(std::string_view bytes, size_t at) {
  uint32_t value = 0;
  for (size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<uint8_t>(bytes[at + i]);
  return value;
}

}  // namespace

std::string withWholePalette(const std::string& png) {
  if (!png.starts_with(kSignature) || png.size() <= kColourType || png[kColourType] != kIndexed)
    return png;
  const auto bits = static_cast<uint8_t>(png[kBitDepth]);
  if (bits > 8) return png;
  const size_t whole = 3 * (size_t{1} << bits);
  for (size_t at = kFirstChunk; at + kChunkFrame <= png.size();) {
    const size_t length = bigEndian(png, at);
    if (length > png.size() - at - kChunkFrame) return png;
    if (png.compare(at + 4, 4, "PLTE") == 0) {
      if (length >= whole) return png;
      std::string out = png;
      out.insert(at + 8 + length, whole - length, '\0');
      for (size_t i = 0; i < 4; ++i) out[at + i] = static_cast<char>(whole >> (24 - 8 * i) & 0xff);
      return out;
    }
    at += kChunkFrame + length;
  }
  return png;
}

}  // namespace bnvpl
