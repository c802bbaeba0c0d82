#include "formats/jpeg_guard.h"

#include <cstddef>

namespace bnvpl {
namespace {

constexpr unsigned kHuffmanTables = 0xc4, kScan = 0xda, kStart = 0xd8;  // markers, after an 0xff
constexpr unsigned kMaxSymbols = 256;
constexpr size_t kMaxScans = 100;  // encoders make about 10

// The byte at an offset; 0 beyond the end, as stb reads it.
unsigned byteAt(std::string_view bytes, size_t at) {
  return at < bytes.size() ? static_cast<unsigned char>(bytes[at]) : 0;
}
size_t lengthAt(std::string_view bytes, size_t at) {
  return byteAt(bytes, at) << 8 | byteAt(bytes, at + 1);
}

// Whether the Huffman tables of the segment fit, whose length field is at `at`.
bool tablesFit(std::string_view bytes, size_t at) {
  const size_t end = at + lengthAt(bytes, at);
  for (at += 2; at < end && at < bytes.size();) {
    unsigned symbols = 0;
    for (size_t i = 1; i <= 16; ++i) symbols += byteAt(bytes, at + i);
    if (symbols > kMaxSymbols) return false;
    at += 17 + symbols;
  }
  return true;
}

}  // namespace

bool isHarmlessJpeg(std::string_view bytes) {
  if (byteAt(bytes, 0) != 0xff) return true;
  size_t scans = 0;
  bool started = false;
  for (size_t at = 0; at + 1 < bytes.size();) {
    const unsigned marker = byteAt(bytes, at + 1);
    if (byteAt(bytes, at) != 0xff || marker == 0xff) {
      ++at;
      continue;
    }
    at += 2;
    if (!started) {
      if (marker != kStart) return true;
      started = true;
      continue;
    }
    if (marker == kHuffmanTables && !tablesFit(bytes, at)) return false;
    if (marker == kScan && ++scans > kMaxScans) return false;
    // Segments are skipped by their length up to the first scan. From there on stb finds the next
    // one in the coded data, so that every marker counts.
    if (scans == 0) at += lengthAt(bytes, at);
  }
  return true;
}

}  // namespace bnvpl
