// FLIP against the claims of the papers, values computed by hand, and flip_oracle.py.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "images/flip/flip_colour.h"
#include "images/flip/flip_filter.h"
#include "images/flip/hdr_flip.h"
#include "tests/support/flat_image.h"
#include "tests/support/threads.h"

namespace bnvpl {
namespace {

constexpr double kPpd = FlipOptions{}.ppd;

RgbImage flat(int width, int height, Vec3 rgb) {
  const Image image = flatImage(width, height, rgb.x, rgb.y, rgb.z);
  return rgbOf(findLayer("", image, ""));
}
RgbImage grey(float value) { return flat(8, 6, Vec3(value)); }

double meanOf(const std::vector<float>& map) {
  return std::accumulate(map.begin(), map.end(), 0.0) / double(map.size());
}
double flipOf(const RgbImage& a, const RgbImage& b) { return meanOf(ldrFlip(a, b, kPpd)); }

// The test pattern of flip_oracle.py; every value is exact in binary.
RgbImage pattern(bool crossed) {
  RgbImage image = flat(40, 24, Vec3(0.0f));
  for (int y = 0; y < 24; ++y) {
    for (int x = 0; x < 40; ++x) {
      for (int c = 0; c < 3; ++c) {
        const int value = (x / 3 * 7 + y / 2 * 13 + c * 5 + (crossed ? x * y : 0)) % 17;
        image.rgb[static_cast<size_t>(c)][static_cast<size_t>(y * 40 + x)] =
            (x < 20 ? 0.25f : 1.0f) * static_cast<float>(value) / 16.0f;
      }
    }
  }
  return image;
}

TEST(Flip, EqualPicturesDifferByExactlyNothing) {
  for (const RgbImage& image : {pattern(true), grey(0.0f), grey(0.3f), grey(1.0f)}) {
    const FlipMaps maps = flipMaps(image, image, {});
    for (const float v : maps.ldr) ASSERT_EQ(v, 0.0f);
    for (const float v : maps.hdr) ASSERT_EQ(v, 0.0f);
  }
}

// FLIP is 1 for green against blue, the colours farthest apart. Black against white has a HyAB
// distance of 100, beyond the knee. CIELAB of the primaries from tables, green (87.735, -86.183,
// 83.179) and blue (32.297, 79.188, -107.860), gives the maximum 203.30^0.7 = 41.275, the knee
// 16.510, and 0.95 + 0.05 (100^0.7 - 16.510) / (41.275 - 16.510) = 0.96738.
TEST(Flip, TheLargestDifferences) {
  EXPECT_NEAR(flipOf(flat(8, 6, {0, 1, 0}), flat(8, 6, {0, 0, 1})), 1.0, 1e-6);
  EXPECT_NEAR(flipOf(grey(0.0f), grey(1.0f)), 0.96738, 2e-5);
}

// Flat pictures have no features and pass the filters unchanged. L* = 50 against 60 has a HyAB
// distance of 10: 0.95 * 10^0.7 / 16.510 = 0.28838. The feature sums vanish up to rounding, 1e-8,
// whose square root remains visible.
TEST(Flip, FlatGreysAsByHand) {
  const auto luminance = [](double lightness) {
    return static_cast<float>(std::pow((lightness + 16.0) / 116.0, 3.0));
  };
  EXPECT_NEAR(flipOf(grey(luminance(50)), grey(luminance(60))), 0.28838, 6e-5);
  EXPECT_NEAR(flipOf(grey(luminance(20)), grey(luminance(30))), 0.28838, 6e-5);
}

TEST(Flip, SymmetricInItsPictures) {
  const RgbImage a = pattern(true), b = pattern(false);
  EXPECT_EQ(ldrFlip(a, b, kPpd), ldrFlip(b, a, kPpd));
  FlipOptions options;
  options.exposureEv = 1.0;
  EXPECT_EQ(flipMaps(a, b, options).hdr, flipMaps(b, a, options).hdr);
}

TEST(Flip, AsTheOracleOfFullTwoDimensionalSums) {
  FlipOptions options;
  options.exposureEv = 0.0;
  options.rangeEv = {{-2.0, 3.0}};
  const FlipMaps maps = flipMaps(pattern(false), pattern(true), options);
  EXPECT_NEAR(meanOf(maps.ldr), 0.3505296, 2e-6);
  EXPECT_NEAR(maps.ldr[5 * 40 + 7], 0.1659315, 1e-5);
  EXPECT_NEAR(maps.ldr[39], 0.3072509, 1e-5);  // pixel in a corner
  EXPECT_EQ(maps.exposures, 5u);
  EXPECT_NEAR(meanOf(maps.hdr), 0.4201921, 2e-6);
  EXPECT_NEAR(maps.hdr[5 * 40 + 7], 0.2849515, 1e-5);
}

// Noise of single pixels blurs away for an observer with more pixels per degree.
TEST(Flip, FineNoiseMattersLessFromFartherAway) {
  RgbImage noisy = flat(40, 40, Vec3(0.5f));
  for (std::vector<float>& channel : noisy.rgb) {
    for (size_t i = 0; i < channel.size(); ++i) channel[i] += (i + i / 40) % 2 == 0 ? 0.2f : -0.2f;
  }
  const RgbImage even = flat(40, 40, Vec3(0.5f));
  const double near = meanOf(ldrFlip(even, noisy, 20.0)), far = meanOf(ldrFlip(even, noisy, 67.0));
  EXPECT_GT(near, 3.0 * far);
  EXPECT_GT(far, 0.0);
}

TEST(Flip, ExtremeValuesAndSizesStayInRange) {
  RgbImage wild = flat(1, 1, {3e38f, -3e38f, 1e-38f});
  for (const double ppd : {1.0, 67.0, 1000.0}) {
    FlipOptions options;
    options.ppd = ppd;
    options.rangeEv = {{-64.0, 64.0}};
    const FlipMaps maps = flipMaps(flat(1, 1, Vec3(0.0f)), wild, options);
    for (const float v : {maps.ldr[0], maps.hdr[0]}) {
      EXPECT_GE(v, 0.0f) << ppd;
      EXPECT_LE(v, 1.0f) << ppd;
    }
    EXPECT_GT(maps.hdr[0], 0.5f);
  }
}

TEST(Flip, TheSameBytesForAnyNumberOfThreads) {
  const RgbImage a = pattern(true), b = pattern(false);
  const auto with = [&](size_t threads) {
    return test::withThreads(threads, [&] { return flipMaps(a, b, {}).hdr; });
  };
  EXPECT_EQ(with(1), with(7));
}

TEST(FlipColour, TablesOfTheParts) {
  const Vec3 white = flip::huntLabFromRgb({1, 1, 1});
  EXPECT_NEAR(white.x, 100.0f, 1e-3);
  EXPECT_NEAR(white.y, 0.0f, 1e-3);
  const Vec3 green = flip::huntLabFromRgb({0, 1, 0});  // CIELAB times 0.87735
  EXPECT_NEAR(green.x, 87.735f, 0.01);
  EXPECT_NEAR(green.y, -86.183f * 0.87735f, 0.02);
  EXPECT_NEAR(green.z, 83.179f * 0.87735f, 0.02);
  const Vec3 colour{0.2f, 0.7f, 0.4f}, back = flip::rgbFromYCxCz(flip::yCxCzFromRgb(colour));
  EXPECT_NEAR(back.x, colour.x, 1e-5);
  EXPECT_NEAR(back.y, colour.y, 1e-5);
  EXPECT_NEAR(back.z, colour.z, 1e-5);
}

TEST(FlipFilter, RadiiAndSumsAtTheUsualDistance) {
  const flip::Filters filters = flip::makeFilters(kPpd);
  EXPECT_EQ(filters.blueYellow.gaussians[0].radius, 10);  // ceil(3 sqrt(0.04 / (2 pi^2)) ppd)
  EXPECT_EQ(filters.point.radius, 9);                     // ceil(3 * 0.041 ppd)
  const auto sums = [](const flip::Kernel& kernel) {
    std::array<double, 2> result{};
    for (const float w : kernel.weights) result[w > 0.0f ? 0 : 1] += double{w};
    return result;
  };
  EXPECT_NEAR(sums(filters.achromatic.gaussians[0])[0], 1.0, 1e-6);
  EXPECT_NEAR(sums(filters.edge)[0], 1.0, 1e-6);
  EXPECT_NEAR(sums(filters.edge)[1], -1.0, 1e-6);
  EXPECT_NEAR(sums(filters.point)[1], -1.0, 1e-6);
}

TEST(HdrFlip, ExposuresFromTheReferenceAndTheirNumber) {
  RgbImage image = flat(3, 1, Vec3(0.0f));
  for (std::vector<float>& channel : image.rgb) channel = {0.0f, 1.0f, 4.0f};  // median 2.5
  const auto [start, stop] = exposureRange(image);
  EXPECT_NEAR(acesCurve(4.0 * std::exp2(start)), 0.85, 1e-5);
  EXPECT_NEAR(acesCurve(2.5 * std::exp2(stop)), 0.85, 1e-5);
  EXPECT_EQ(exposureRange(grey(0.0f)), (std::array<double, 2>{0.0, 0.0}));
  EXPECT_EQ(exposureCount(-4.0, 10.0), 14u);
  EXPECT_EQ(exposureCount(0.0, 4.2), 5u);
  EXPECT_EQ(exposureCount(1.0, 1.0), 2u);
}

TEST(HdrFlip, AcesCurveByHand) {
  EXPECT_EQ(acesCurve(0.0), 0.0f);
  EXPECT_EQ(acesCurve(-5.0), 0.0f);
  EXPECT_EQ(acesCurve(1e30), 1.0f);
  // 0.6 (2.51 * 0.6 + 0.03) / (0.6 (2.43 * 0.6 + 0.59) + 0.14) = 0.9216 / 1.3688
  EXPECT_NEAR(acesCurve(1.0), 0.9216 / 1.3688, 1e-6);
}

// A difference that is overexposed or too dark at one exposure is visible at another.
TEST(HdrFlip, SeesWhatOneExposureHides) {
  FlipOptions options;
  options.exposureEv = 0.0;
  const FlipMaps bright = flipMaps(grey(20.0f), grey(40.0f), options);
  EXPECT_EQ(bright.ldr[0], 0.0f);
  EXPECT_GT(bright.hdr[0], 0.2f);
  const FlipMaps dark = flipMaps(grey(1e-3f), grey(2e-3f), options);
  EXPECT_LT(dark.ldr[0], 0.1f);
  EXPECT_GT(dark.hdr[0], 0.2f);
}

TEST(HdrFlip, MiddleGreyExposureInQuarters) {
  EXPECT_EQ(middleGreyEv(grey(0.18f)), 0.0);
  EXPECT_EQ(middleGreyEv(grey(0.045f)), 2.0);
  EXPECT_EQ(middleGreyEv(grey(0.17f)), 0.0);
  EXPECT_EQ(middleGreyEv(grey(0.0f)), 0.0);
}

}  // namespace
}  // namespace bnvpl
