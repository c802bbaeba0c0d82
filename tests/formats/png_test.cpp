#include <limits>

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
