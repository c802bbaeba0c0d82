// False-colour pictures of an error measure.
#include "images/error_map.h"

#include <gtest/gtest.h>

#include <cmath>

#include "images/comparison.h"
#include "images/difference_image.h"
#include "tests/support/flat_image.h"

namespace bnvpl {
namespace {

Rgb8 pixel(const Picture& picture, int x, int y) {
  const size_t at =
      3 * (static_cast<size_t>(y) * static_cast<size_t>(picture.width) + static_cast<size_t>(x));
  return {picture.rgb8[at], picture.rgb8[at + 1], picture.rgb8[at + 2]};
}

double lightness(Rgb8 colour) {  // luminance has the same order as CIE lightness
  const auto linear = [](uint8_t v) { return std::pow(v / 255.0, 2.2); };
  return 0.2126 * linear(colour[0]) + 0.7152 * linear(colour[1]) + 0.0722 * linear(colour[2]);
}

TEST(ErrorMap, LighterMeansMore) {
  for (int i = 1; i <= 40; ++i) {
    EXPECT_GT(lightness(errorColour(i / 40.0)), lightness(errorColour((i - 1) / 40.0))) << i;
  }
  EXPECT_LT(lightness(errorColour(0.0)), 0.01);
  EXPECT_GT(lightness(errorColour(1.0)), 0.8);
  EXPECT_EQ(errorColour(-1.0), errorColour(0.0));
  EXPECT_EQ(errorColour(7.0), errorColour(1.0));
}

TEST(ErrorMap, TheMeanOfAMapIsItsMeasure) {
  Image a = flatImage(3, 2, 1, 2, 3), b = flatImage(3, 2, 2, 2, 2);
  a.channels[1].data = {0, 1, 2, 3, 4, 5};
  b.channels[2].data = {0, 0, 2, 3, 4, 9};
  const Layer la = findLayer("a", a, ""), lb = findLayer("b", b, "");
  const Comparison c = compareLayers("a", la, "b", lb);
  EXPECT_NEAR(weightedMean(relMseMap(la, lb, c.epsilon).values, {}) / c.relMse, 1.0, 1e-6);
  EXPECT_NEAR(weightedMean(smapeMap(la, lb).values, {}) / c.smape, 1.0, 1e-6);
}

TEST(ErrorMap, ColoursFollowTheScaleAndMaskedPixelsAreGrey) {
  ErrorMap map;
  map.values.assign(400, 0.0f);
  map.values[1] = 0.5f;
  map.values[2] = 2.0f;
  map.largest = 2.0;
  map.title = "FLIP";
  Mask mask{std::vector<double>(400, 1.0)};
  mask.weights[3] = 0.0;
  const Picture straight = errorPicture(map, 200, 2, mask);
  ASSERT_EQ(straight.width, 200);
  ASSERT_EQ(straight.height, 2 + kTitledLegendHeight);
  EXPECT_EQ(pixel(straight, 0, 0), errorColour(0.0));
  EXPECT_EQ(pixel(straight, 1, 0), errorColour(0.25));
  EXPECT_EQ(pixel(straight, 2, 0), errorColour(1.0));
  EXPECT_EQ(pixel(straight, 3, 0), kLeftOut);
  map.logarithmic = true;  // four decades; 0.0002 is at the left end
  map.values[4] = 0.02f;
  const Picture decades = errorPicture(map, 200, 2, mask);
  EXPECT_EQ(pixel(decades, 0, 0), errorColour(0.0));
  EXPECT_EQ(pixel(decades, 2, 0), errorColour(1.0));
  EXPECT_EQ(pixel(decades, 4, 0), errorColour(0.5));
}

TEST(ErrorMap, TheLegendHasTheBarNumbersAndTheName) {
  ErrorMap map;
  map.values.assign(4, 0.0f);
  map.title = "HDR-FLIP -4 TO +10 EV";
  const Picture picture = errorPicture(map, 2, 2);
  ASSERT_EQ(picture.width, kMinLegendWidth);
  EXPECT_EQ(pixel(picture, 14, 2 + 6), errorColour(0.0));
  EXPECT_EQ(pixel(picture, kMinLegendWidth - 15, 2 + 6), errorColour(1.0));
  const auto ink = [&](int top, int bottom) {
    int count = 0;
    for (int y = top; y < bottom; ++y) {
      for (int x = 0; x < picture.width; ++x) count += pixel(picture, x, y) == Rgb8{0, 0, 0};
    }
    return count;
  };
  EXPECT_GT(ink(2 + 15, 2 + 22), 100);  // labels 0 0.25 0.5 0.75 1
  EXPECT_GT(ink(2 + 26, 2 + 33), 150);  // the title
}

TEST(DifferencePicture, MaskedPixelsAreGreyAndDoNotCount) {
  Image a = flatImage(200, 1, 2, 2, 2), b = flatImage(200, 1, 1, 1, 1);
  for (ImageChannel& channel : b.channels) channel.data[0] = 1e6f;
  Mask mask{std::vector<double>(200, 1.0)};
  mask.weights[0] = 0.0;
  const Layer la = findLayer("a", a, ""), lb = findLayer("b", b, "");
  const Picture masked = differencePicture(la, lb, 2.0, mask), all = differencePicture(la, lb, 2.0);
  EXPECT_EQ(pixel(masked, 0, 0), kLeftOut);
  EXPECT_EQ(pixel(masked, 1, 0), differenceColour(1.0 / 1.1 / 2.0));
  EXPECT_EQ(pixel(all, 1, 0), differenceColour(1.0 / 501.0 / 2.0));  // 0.1 mean(b) is 500
}

}  // namespace
}  // namespace bnvpl
