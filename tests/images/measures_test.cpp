// SMAPE, measures per channel and of luminance, and masks.
#include <cmath>

#include "formats/image/png_io.h"
#include "images/comparison.h"
#include "tests/formats/test_files.h"
#include "tests/support/flat_image.h"
#include "tests/support/messages.h"

namespace bnvpl {
namespace {

Comparison compareMasked(const Image& a, const Image& b, const Mask& mask = {},
                         const Image* second = nullptr) {
  const Layer la = findLayer("a.exr", a, ""), lb = findLayer("b.exr", b, "");
  if (second == nullptr) return compareLayers("a.exr", la, "b.exr", lb, 0.25, nullptr, mask);
  const Layer ls = findLayer("s.exr", *second, "");
  return compareLayers("a.exr", la, "b.exr", lb, 0.25, &ls, mask);
}

// Two pixels: (3, 1, 1) against (1, 1, 1), and (1, 0, 1) against (1, 1, 1).
Image twoPixels() {
  Image image = flatImage(2, 1, 1, 1, 1);
  image.channels[0].data = {3, 1};
  image.channels[1].data = {1, 0};
  return image;
}

TEST(Measures, OfEachChannelByHand) {
  const Comparison c = compareMasked(twoPixels(), flatImage(2, 1, 1, 1, 1));
  EXPECT_DOUBLE_EQ(c.channels[0].rmse, std::sqrt(2.0));
  EXPECT_DOUBLE_EQ(c.channels[1].rmse, std::sqrt(0.5));
  EXPECT_EQ(c.channels[2].rmse, 0.0);
  EXPECT_DOUBLE_EQ(c.channels[0].relMse, 2.0 / 1.25);  // epsilon 0.25 from the mean of all
  EXPECT_DOUBLE_EQ(c.channels[1].relMse, 0.5 / 1.25);
  EXPECT_DOUBLE_EQ(c.channels[0].smape, 0.25);  // 2 / 4 and 0
  EXPECT_DOUBLE_EQ(c.channels[1].smape, 0.5);   // 0 and 1 / 1
  EXPECT_DOUBLE_EQ(c.smape, 0.25);
}

TEST(Measures, LuminanceByHand) {
  const Comparison c = compareMasked(twoPixels(), flatImage(2, 1, 1, 1, 1));
  ASSERT_TRUE(c.luminance);
  const double y1 = 1.0 + 2.0 * 0.2126, y2 = 1.0 - 0.7152;
  EXPECT_NEAR(c.luminance->meanA, (y1 + y2) / 2.0, 1e-12);
  EXPECT_NEAR(c.luminance->meanB, 1.0, 1e-12);
  const double squares = (y1 - 1.0) * (y1 - 1.0) + (y2 - 1.0) * (y2 - 1.0);
  EXPECT_NEAR(c.luminance->rmse, std::sqrt(squares / 2.0), 1e-12);
  EXPECT_NEAR(c.luminance->relMse, squares / 2.0 / 1.25, 1e-12);
  EXPECT_NEAR(c.luminance->smape, ((y1 - 1) / (y1 + 1) + (1 - y2) / (1 + y2)) / 2, 1e-12);
}

TEST(Measures, OnlyLightHasALuminance) {
  Image image = flatImage(1, 1, 1, 1, 1);
  for (const char* name : {"N.X", "N.Y", "N.Z"}) image.add(name) = {0.5f};
  const Layer normals = findLayer("a.exr", image, "N");
  const Comparison c = compareLayers("a.exr", normals, "a.exr", normals);
  EXPECT_FALSE(c.luminance);
}

TEST(Measures, SmapeIsSymmetricBoundedAndWithoutAUnit) {
  const Image a = twoPixels(), b = flatImage(2, 1, 1, 1, 1), black = flatImage(2, 1, 0, 0, 0);
  EXPECT_EQ(compareMasked(a, b).smape, compareMasked(b, a).smape);
  EXPECT_EQ(compareMasked(b, black).smape, 1.0);
  EXPECT_EQ(compareMasked(black, black).smape, 0.0);
  Image a8 = a, b8 = b;
  for (Image* image : {&a8, &b8}) {
    for (ImageChannel& channel : image->channels) {
      for (float& v : channel.data) v *= 8.0f;
    }
  }
  EXPECT_DOUBLE_EQ(compareMasked(a8, b8).smape, compareMasked(a, b).smape);
  EXPECT_EQ(compareMasked(b, flatImage(2, 1, -1, -1, -1)).smape, 1.0);  // signs that differ
}

// Halves of 3 and 5 have the mean 4, so an image of 4 has no error.
TEST(Measures, SmapeTakesTheMeanOfBothHalves) {
  const Image a = flatImage(2, 1, 4, 4, 4), b = flatImage(2, 1, 3, 3, 3),
              second = flatImage(2, 1, 5, 5, 5);
  EXPECT_EQ(compareMasked(a, b, {}, &second).smape, 0.0);
  EXPECT_DOUBLE_EQ(compareMasked(a, b).smape, 1.0 / 7.0);
}

TEST(Measures, AMaskWeighsEveryMean) {
  const Image a = twoPixels(), b = flatImage(2, 1, 1, 1, 1);
  const Comparison first = compareMasked(a, b, Mask{{1.0, 0.0}});
  EXPECT_DOUBLE_EQ(first.channels[0].meanA, 3.0);
  EXPECT_DOUBLE_EQ(first.channels[0].rmse, 2.0);
  EXPECT_DOUBLE_EQ(first.rmse, std::sqrt(4.0 / 3.0));
  EXPECT_EQ(first.channels[1].rmse, 0.0);
  EXPECT_EQ(first.worstPixel[0], 0u);
  EXPECT_EQ(first.maskPixels, 1.0);
  const Comparison second = compareMasked(a, b, Mask{{0.0, 1.0}});
  EXPECT_EQ(second.worstPixel[0], 1u);
  EXPECT_DOUBLE_EQ(second.rmse, std::sqrt(1.0 / 3.0));
  const Comparison part = compareMasked(a, b, Mask{{1.0, 0.25}});
  EXPECT_DOUBLE_EQ(part.channels[0].meanA, (3.0 + 0.25) / 1.25);
  EXPECT_DOUBLE_EQ(part.channels[1].smape, 0.25 / 1.25);
  EXPECT_DOUBLE_EQ(part.channels[1].rmse, std::sqrt(0.25 / 1.25));
  EXPECT_DOUBLE_EQ(part.channels[1].relMse, 0.25 / (1.0 + part.epsilon) / 1.25);
  EXPECT_DOUBLE_EQ(part.rmse, std::sqrt((4.0 + 0.25) / 1.25 / 3.0));
  EXPECT_DOUBLE_EQ(weightedMean({2.0f, 7.0f}, Mask{{1.0, 0.25}}), 3.0);
  EXPECT_DOUBLE_EQ(compareMasked(a, b, Mask{{1.0, 1.0}}).rmse, compareMasked(a, b).rmse);
}

TEST(Measures, AnEqualImageInsideTheMaskIsExact) {
  Image a = flatImage(2, 1, 1, 1, 1);
  a.channels[2].data[1] = 100.0f;
  const Comparison c = compareMasked(a, flatImage(2, 1, 1, 1, 1), Mask{{1.0, 0.0}});
  EXPECT_EQ(c.rmse, 0.0);
  EXPECT_EQ(c.relMse, 0.0);
  EXPECT_EQ(c.smape, 0.0);
  EXPECT_EQ(c.luminance->meanA, c.luminance->meanB);
}

class MaskFile : public TestFolder {
 protected:
  // A PNG file of pixels with three bytes each.
  fs::path png(int width, int height, const std::vector<uint8_t>& rgb8) const {
    writePng(at("mask.png"), width, height, rgb8);
    return at("mask.png");
  }
  std::string refusal(const fs::path& file) const {
    return messageOf<InputError>([&] { readMask(file, "b.exr", layer()); });
  }
  Layer layer() const { return findLayer("b.exr", image_, ""); }

 private:
  Image image_ = flatImage(2, 1, 1, 1, 1);
};

TEST_F(MaskFile, WhiteCountsBlackDoesNotGreyInPart) {
  const Mask white = readMask(png(2, 1, {255, 255, 255, 0, 0, 0}), "b.exr", layer());
  EXPECT_EQ(white.weights, (std::vector<double>{1.0, 0.0}));
  const Mask part = readMask(png(2, 1, {51, 51, 51, 255, 255, 255}), "b.exr", layer());
  EXPECT_DOUBLE_EQ(part.weights[0], 0.2);
  EXPECT_DOUBLE_EQ(part.sum(2), 1.2);
}

TEST_F(MaskFile, RefusesWhatIsNoMask) {
  const std::string size = refusal(png(1, 2, {0, 0, 0, 0, 0, 0}));
  EXPECT_TRUE(contains(size, "mask.png: 1 x 2") && contains(size, "b.exr has 2 x 1")) << size;
  const std::string colour = refusal(png(2, 1, {255, 255, 255, 9, 8, 9}));
  EXPECT_TRUE(contains(colour, "(1, 0) is coloured")) << colour;
  EXPECT_TRUE(contains(refusal(png(2, 1, {0, 0, 0, 0, 0, 0})), "black all over"));
  const std::string whole = readAll(png(2, 1, {255, 255, 255, 0, 0, 0}));
  writeAll(at("cut.png"), whole.substr(0, whole.size() / 2));
  EXPECT_TRUE(contains(refusal(at("cut.png")), "no readable PNG"));
  EXPECT_TRUE(contains(refusal(at("absent.png")), "cannot be read"));
  EXPECT_TRUE(contains(refusal(at("")), "cannot be read"));
}

}  // namespace
}  // namespace bnvpl
