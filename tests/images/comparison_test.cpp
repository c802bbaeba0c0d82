#include "images/comparison.h"

#include <gtest/gtest.h>

#include <cmath>

#include "images/difference_image.h"
#include "tests/support/flat_image.h"
#include "tests/support/messages.h"

namespace bnvpl {
namespace {

Comparison compare(const Image& a, const Image& b, double epsilon = kRelMseEpsilon) {
  return compareLayers("a.exr", findLayer("a.exr", a, ""), "b.exr", findLayer("b.exr", b, ""),
                       epsilon);
}

TEST(Compare, MeasuresAreThoseComputedByHand) {
  Image a = flatImage(2, 1, 1, 1, 1), b = flatImage(2, 1, 1, 1, 1);
  a.channels[0].data = {3, 1};  // differences: R 2 0, G 0 -1, B 0 0
  a.channels[1].data = {1, 0};
  const Comparison c = compare(a, b, 0.25);
  EXPECT_DOUBLE_EQ(c.meanB, 1.0);
  EXPECT_DOUBLE_EQ(c.meanA, 7.0 / 6.0);
  EXPECT_DOUBLE_EQ(c.mse, 5.0 / 6.0);
  EXPECT_DOUBLE_EQ(c.rmse, std::sqrt(5.0 / 6.0));
  EXPECT_DOUBLE_EQ(c.relMse, 5.0 / 1.25 / 6.0);
  EXPECT_DOUBLE_EQ(c.epsilon, 0.25);
  EXPECT_DOUBLE_EQ(c.channels[0].meanA, 2.0);
  EXPECT_DOUBLE_EQ(c.channels[1].meanA, 0.5);
  EXPECT_EQ(c.worstPixel[0], 0u);
  EXPECT_EQ(c.worstPixel[1], 0u);
}

TEST(Compare, EpsilonFollowsTheReferenceOnly) {
  const Image a = flatImage(1, 1, 30, 30, 30), b = flatImage(1, 1, 10, 10, 10);
  const Comparison ab = compare(a, b), ba = compare(b, a);
  EXPECT_DOUBLE_EQ(ab.epsilon, 1e-4 * 100.0);
  EXPECT_DOUBLE_EQ(ab.relMse, 400.0 / (100.0 + 0.01));
  EXPECT_DOUBLE_EQ(ba.relMse, 400.0 / (900.0 + 0.09));
  EXPECT_DOUBLE_EQ(ab.meanRatio(), 3.0);
  EXPECT_DOUBLE_EQ(ab.rmseOverMean(), 2.0);
}

// Scaling both images changes no relative measure.
TEST(Compare, RelativeMeasuresDoNotDependOnTheUnit) {
  Image a = flatImage(2, 2, 1, 2, 3), b = flatImage(2, 2, 1, 2, 2);
  const Comparison before = compare(a, b);
  for (Image* image : {&a, &b}) {
    for (ImageChannel& channel : image->channels) {
      for (float& v : channel.data) v *= 1024.0f;
    }
  }
  const Comparison after = compare(a, b);
  EXPECT_DOUBLE_EQ(before.relMse, after.relMse);
  EXPECT_DOUBLE_EQ(before.rmseOverMean(), after.rmseOverMean());
}

TEST(Compare, BlackImages) {
  const Image black = flatImage(2, 1, 0, 0, 0), grey = flatImage(2, 1, 1, 1, 1);
  EXPECT_EQ(compare(black, black).relMse, 0.0);
  EXPECT_TRUE(std::isinf(compare(grey, black).relMse));
}

TEST(Compare, LayersAreFoundByName) {
  Image image = flatImage(1, 1, 1, 1, 1);
  for (const char* name : {"indirect.R", "indirect.G", "indirect.B"}) image.add(name) = {5};
  for (const char* name : {"N.X", "N.Y", "N.Z"}) image.add(name) = {7};
  image.add("Z") = {9};
  EXPECT_EQ(findLayer("a", image, "").data[0]->at(0), 1.0f);
  EXPECT_EQ(findLayer("a", image, "indirect").data[2]->at(0), 5.0f);
  EXPECT_EQ(findLayer("a", image, "N").data[1]->at(0), 7.0f);
  EXPECT_EQ(findLayer("a", image, "Z").data.size(), 1u);
  const std::string message = messageOf<InputError>([&] { findLayer("a.exr", image, "direct"); });
  EXPECT_TRUE(contains(message, "a.exr") && contains(message, "indirect")) << message;
}

TEST(Compare, RefusesOtherSizesAndValuesThatAreNotFinite) {
  const Image a = flatImage(3, 2, 1, 1, 1);
  EXPECT_TRUE(
      contains(messageOf<InputError>([&] { compare(a, flatImage(2, 3, 1, 1, 1)); }), "3 x 2"));
  for (const float bad : {NAN, INFINITY, -INFINITY}) {
    Image b = a;
    b.channels[1].data[4] = bad;
    const std::string message = messageOf<InputError>([&] { compare(a, b); });
    EXPECT_TRUE(contains(message, "b.exr") && contains(message, "channel G") &&
                contains(message, "(1, 1)"))
        << message;
  }
}

TEST(DifferencePicture, BlueIsDarkerWhiteEqualRedBrighter) {
  Image a = flatImage(200, 3, 1, 1, 1), b = a;
  for (ImageChannel& channel : a.channels) {
    channel.data[0] = 0.5f;
    channel.data[1] = 2.0f;
  }
  const Picture p = differencePicture(findLayer("a", a, ""), findLayer("b", b, ""), 0.5);
  ASSERT_EQ(p.width, 200);
  ASSERT_EQ(p.height, 3 + kLegendHeight);
  EXPECT_GT(p.rgb8[2], p.rgb8[0] + 60);  // -45 %
  EXPECT_GT(p.rgb8[3], p.rgb8[5] + 60);  // +91 %
  EXPECT_EQ(p.rgb8[6], 255);
  EXPECT_EQ(p.rgb8[7], 255);
  EXPECT_EQ(p.rgb8[8], 255);
  size_t black = 0;  // the numbers of the legend
  for (size_t i = 3u * 200u * 3u; i < p.rgb8.size(); i += 3) {
    black += p.rgb8[i] == 0 && p.rgb8[i + 1] == 0 && p.rgb8[i + 2] == 0;
  }
  EXPECT_GT(black, 100u);
}

TEST(DifferencePicture, ColoursAreMonotoneAndClamped) {
  EXPECT_EQ(differenceColour(0.0), (std::array<uint8_t, 3>{255, 255, 255}));
  EXPECT_EQ(differenceColour(5.0), differenceColour(1.0));
  EXPECT_EQ(differenceColour(-INFINITY), differenceColour(-1.0));
  for (int i = 1; i <= 20; ++i) {
    EXPECT_LE(differenceColour(i / 20.0)[1], differenceColour((i - 1) / 20.0)[1]);
    EXPECT_LE(differenceColour(-i / 20.0)[0], differenceColour((1 - i) / 20.0)[0]);
  }
}

// Errors of +1 and -1 in the two halves cancel: the image equals the mean of the halves.
TEST(Compare, ASecondHalfRemovesTheNoise) {
  Image a, b, second;
  for (Image* image : {&a, &b, &second}) {
    image->width = 2;
    image->height = 1;
    for (const char* name : {"R", "G", "B"}) image->add(name) = {4.0f, 4.0f};
  }
  for (ImageChannel& channel : b.channels) channel.data = {5.0f, 3.0f};
  for (ImageChannel& channel : second.channels) channel.data = {5.0f, 5.0f};
  const Layer la = findLayer("a", a, ""), lb = findLayer("b", b, ""),
              ls = findLayer("s", second, "");
  EXPECT_DOUBLE_EQ(compareLayers("a", la, "b", lb).rmse, 1.0);
  // (4-5)(4-5) = 1 and (4-3)(4-5) = -1.
  EXPECT_DOUBLE_EQ(compareLayers("a", la, "b", lb, kRelMseEpsilon, &ls).rmse, 0.0);
}

}  // namespace
}  // namespace bnvpl
