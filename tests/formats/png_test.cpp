#include <zlib.h>

#include <limits>
#include <map>

#include "formats/image/pixels_io.h"
#include "formats/image/png_io.h"
#include "formats/image/tonemap.h"
#include "tests/formats/test_files.h"

namespace bnvpl {
namespace {

using Png = TestFolder;

TEST_F(Png, HasSignatureSizeAndEqualBytesEachTime) {
  const std::vector<uint8_t> pixels(3 * 5 * 2, 200);
  writePng(at("a.png"), 5, 2, pixels);
  writePng(at("b.png"), 5, 2, pixels);
  const std::string bytes = readAll(at("a.png"));
  EXPECT_EQ(bytes.substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_EQ(bytes.substr(16, 8), std::string("\0\0\0\5\0\0\0\2", 8));  // IHDR, big-endian
  EXPECT_TRUE(bytes == readAll(at("b.png")));
  EXPECT_EQ(fileCount(), 2u);
}

TEST_F(Png, WrongSizesAndTargetsAreRefused) {
  const std::vector<uint8_t> pixels(12);
  EXPECT_THROW(writePng(at("a.png"), 2, 3, pixels), OutputError);
  EXPECT_THROW(writePng(at("a.png"), 0, 0, {}), OutputError);
  EXPECT_THROW(writePng(at("missing") / "a.png", 2, 2, pixels), OutputError);
}

// The chunks of a PNG by their types.
std::map<std::string, std::string> chunksOf(const std::string& png) {
  std::map<std::string, std::string> chunks;
  for (size_t at = 8; at + 12 <= png.size();) {
    size_t length = 0;
    for (size_t i = 0; i < 4; ++i) length = length << 8 | static_cast<unsigned char>(png[at + i]);
    chunks[png.substr(at + 4, 4)] = png.substr(at + 8, length);
    at += 12 + length;
  }
  return chunks;
}

TEST_F(Png, TellsColoursProgramAndHistory) {
  std::vector<uint8_t> pixels(3 * 5 * 2);
  for (size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<uint8_t>(8 * i);
  const std::string history =
      "[{\"tool\":\"vpl-render\",\"name\":\"K\xc3\xbc"
      "che\"}]";
  AtomicFile file(at("a.png"));
  writePng(file, 5, 2, pixels, 3, history);
  file.commit();
  auto chunks = chunksOf(readAll(at("a.png")));
  EXPECT_EQ(chunks["sRGB"], std::string("\1"));               // relative colorimetric
  EXPECT_EQ(chunks["gAMA"], std::string("\0\0\xb1\x8f", 4));  // 45455
  EXPECT_EQ(chunks["cHRM"].size(), 32u);
  EXPECT_TRUE(chunks["tEXt"].starts_with(std::string("Software\0bnvpl ", 15)));
  const std::string head = std::string("bnvpl.provenance") + '\0' + "\1" + std::string(3, '\0');
  const std::string text = chunks["iTXt"];
  ASSERT_EQ(text.substr(0, head.size()), head);
  std::string unpacked(1000, '\0');
  uLongf size = unpacked.size();
  ASSERT_EQ(uncompress(reinterpret_cast<Bytef*>(unpacked.data()), &size,
                       reinterpret_cast<const Bytef*>(text.data() + head.size()),
                       text.size() - head.size()),
            Z_OK);
  EXPECT_EQ(unpacked.substr(0, size), history);
  EXPECT_EQ(decodePng(at("a.png"), readAll(at("a.png"))).values, pixels);
  writePng(at("b.png"), 5, 2, pixels);
  EXPECT_EQ(chunksOf(readAll(at("b.png"))).count("iTXt"), 0u);
}

// The difference of two images of 1 x 16384 with a frame around it has such sides.
TEST_F(Png, LongSides) {
  for (const auto& [width, height] : {std::pair{3, 17000}, std::pair{17000, 3}}) {
    const std::vector<uint8_t> pixels(size_t{3} * 3 * 17000, 128);
    writePng(at("a.png"), width, height, pixels);
    EXPECT_GT(fs::file_size(at("a.png")), 0u);
  }
}

TEST(Tonemap, FollowsTheSrgbCurve) {
  EXPECT_EQ(toSrgb8(0.0f), 0);
  EXPECT_EQ(toSrgb8(1.0f), 255);
  EXPECT_EQ(toSrgb8(0.002f), 7);         // 12.92 x
  EXPECT_EQ(toSrgb8(0.21404114f), 128);  // half of the code values
  EXPECT_EQ(toSrgb8(1e30f), 255);
  EXPECT_EQ(toSrgb8(-1.0f), 0);
  EXPECT_EQ(toSrgb8(std::numeric_limits<float>::quiet_NaN()), 0);
  EXPECT_EQ(toSrgb8(0.25f, 2.0f), 255);
  EXPECT_EQ(toSrgb8(0.5f, -1.0f), toSrgb8(0.25f));
}

TEST(Tonemap, InterleavesChannels) {
  const std::vector<float> r{1.0f, 0.0f}, g{0.0f, 1.0f}, b{0.0f, 0.0f};
  EXPECT_EQ(toSrgb8(r, g, b, 0.0f), (std::vector<uint8_t>{255, 0, 0, 0, 255, 0}));
}

}  // namespace
}  // namespace bnvpl
