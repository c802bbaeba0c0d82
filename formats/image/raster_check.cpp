#include "formats/image/raster_check.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <optional>

namespace bnvpl {
namespace {

// Little-endian number of `count` bytes; bytes beyond the end are 0.
uint32_t numberAt(std::string_view bytes, size_t at, size_t count) {
  uint32_t value = 0;
  for (size_t i = 0; i < count && at + i < bytes.size(); ++i)
    value |= static_cast<uint32_t>(static_cast<uint8_t>(bytes[at + i])) << (8 * i);
  return value;
}

struct BmpHeader {
  uint64_t pixels, headerBytes;  // where the pixels begin; size of the header behind byte 14
  int64_t width, height;         // height is negative for rows from the top
  uint32_t bits;
  bool old() const { return headerBytes == 12; }  // OS/2 1
  uint64_t palette() const { return 14 + headerBytes; }
};

std::optional<BmpHeader> bmpHeader(std::string_view bytes) {
  if (!bytes.starts_with("BM")) return {};
  BmpHeader h{numberAt(bytes, 10, 4), numberAt(bytes, 14, 4), 0, 0, 0};
  if (h.old()) {
    h.width = numberAt(bytes, 18, 2), h.height = numberAt(bytes, 20, 2);
    h.bits = numberAt(bytes, 24, 2);
  } else {
    h.width = static_cast<int32_t>(numberAt(bytes, 18, 4));
    h.height = static_cast<int32_t>(numberAt(bytes, 22, 4));
    h.bits = numberAt(bytes, 28, 2);
  }
  return h;
}

bool lacksBmpPixels(std::string_view bytes, const BmpHeader& h) {
  if (h.width < 1 || h.height == 0 || h.bits > 32) return false;  // refused by stb_image
  const uint64_t bits = static_cast<uint64_t>(h.width) * h.bits;
  const uint64_t rows = static_cast<uint64_t>(std::abs(h.height));
  return h.pixels + (rows - 1) * ((bits + 31) / 32 * 4) + (bits + 7) / 8 > bytes.size();
}

bool lacksTgaPixels(std::string_view bytes) {
  constexpr size_t kHeader = 18;
  constexpr uint32_t kRunLength = 8;  // bit of the type
  const auto bytesOf = [](uint32_t bits) { return (bits + 7) / 8; };
  const bool indexed = numberAt(bytes, 1, 1) == 1;
  const size_t each = bytesOf(numberAt(bytes, 16, 1));
  const size_t pixels = size_t{numberAt(bytes, 12, 2)} * numberAt(bytes, 14, 2);
  size_t at = kHeader + numberAt(bytes, 0, 1);
  if (indexed)
    at += numberAt(bytes, 3, 2) + size_t{numberAt(bytes, 5, 2)} * bytesOf(numberAt(bytes, 7, 1));
  if ((numberAt(bytes, 2, 1) & kRunLength) == 0) return at + pixels * each > bytes.size();
  for (size_t done = 0; done < pixels;) {
    if (at >= bytes.size()) return true;
    const uint32_t packet = numberAt(bytes, at, 1), count = 1 + (packet & 127);
    const size_t wanted = std::min<size_t>(count, pixels - done);
    at += 1 + each * (packet > 127 ? 1 : wanted);
    done += count;
  }
  return at > bytes.size();
}

}  // namespace

bool lacksPixels(std::string_view bytes) {
  const std::optional<BmpHeader> bmp = bmpHeader(bytes);
  return bmp ? lacksBmpPixels(bytes, *bmp) : lacksTgaPixels(bytes);
}

std::string withWholePalette(const std::string& bmp) {
  const std::optional<BmpHeader> h = bmpHeader(bmp);
  if (!h || h->bits > 8 || h->pixels < h->palette() || h->pixels > bmp.size()) return bmp;
  // stb_image takes the palette of an old file for 12 bytes shorter than it is.
  const uint64_t whole = (uint64_t{1} << h->bits) * (h->old() ? 3 : 4) + (h->old() ? 12 : 0);
  const uint64_t has = h->pixels - h->palette();
  if (has >= whole) return bmp;
  std::string out = bmp;
  out.insert(h->pixels, whole - has, '\0');
  const uint64_t pixels = h->palette() + whole;
  for (size_t i = 0; i < 4; ++i) out[10 + i] = static_cast<char>(pixels >> (8 * i) & 0xff);
  return out;
}

}  // namespace bnvpl
