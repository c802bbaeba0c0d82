// Palettes that are shorter than what pixels name.
#include "formats/png_palette.h"

#include <gtest/gtest.h>

#include "formats/pixels_io.h"

namespace bnvpl {
namespace {

std::string chunk(const std::string& type, const std::string& data) {
  std::string out;
  for (int shift = 24; shift >= 0; shift -= 8)
    out += static_cast<char>(data.size() >> shift & 0xff);
  return out + type + data + std::string(4, '\0');  // stb_image ignores checksums
}

// Two pixels of 8 bits, which name the entries 0 and `index` of a palette.
std::string indexedPng(const std::string& palette, char index) {
  const std::string header{0, 0, 0, 2, 0, 0, 0, 1, 8, 3, 0, 0, 0};
  // One stored block of deflate: a filter byte and two pixels.
  std::string data{0x78, 0x01, 0x01, 0x03, 0x00, char(0xfc), char(0xff), 0x00, 0x00, index};
  data += std::string(4, '\0');
  return "\x89PNG\r\n\x1a\n" + chunk("IHDR", header) + chunk("PLTE", palette) +
         chunk("IDAT", data) + chunk("IEND", "");
}

TEST(PngPalette, EntriesThatAreMissingAreBlack) {
  const std::string png = indexedPng("\x0a\x14\x1e", char(200));
  EXPECT_EQ(withWholePalette(png).size(), png.size() + 3 * 255);
  const Pixels read = decodePixels("p.png", png, 3);
  EXPECT_EQ(read.values, (std::vector<uint8_t>{10, 20, 30, 0, 0, 0}));
}

TEST(PngPalette, WholePalettesAndOtherFilesStay) {
  const std::string whole = indexedPng(std::string(3 * 256, 'a'), char(200));
  EXPECT_EQ(withWholePalette(whole), whole);
  EXPECT_EQ(decodePixels("p.png", whole, 3).values, std::vector<uint8_t>(6, 'a'));
  for (const std::string& other : {std::string("BM"), std::string(), whole.substr(0, 40)})
    EXPECT_EQ(withWholePalette(other), other);
}

}  // namespace
}  // namespace bnvpl
