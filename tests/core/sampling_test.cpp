// Each warp is tested against its density: the density integrates to 1, and the samples follow it.
#include "core/sampling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "core/cdf.h"
#include "core/random.h"
#include "core/random_streams.h"
#include "core/winsorized_mean.h"

namespace bnvpl {
namespace {

// Integrates a function of z = cos(theta) over the sphere by the midpoint rule.
double overSphere(const std::function<double(double)>& f) {
  constexpr int kSteps = 200000;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) sum += f(-1.0 + 2.0 * (i + 0.5) / kSteps);
  return sum * 2.0 / kSteps * 2.0 * double{kPi};
}

TEST(WinsorizedMean, AFewHugeValuesDecideNothing) {
  EXPECT_EQ(winsorizedMean({}), 0.0);
  EXPECT_EQ(winsorizedMean({1, 2, 3, 6}), 3.0);  // the percentile of a few values is the largest
  std::vector<float> values(1000, 1.0f);
  for (size_t i = 0; i < 300; ++i) values[i] = 2.0f;
  EXPECT_NEAR(winsorizedMean(values), 1.3, 1e-6);
  for (size_t i = 0; i < 9; ++i) values[i] = 1e30f;
  EXPECT_NEAR(winsorizedMean(values), 1.3, 1e-6);
  values[500] = NAN, values[501] = INFINITY;
  EXPECT_NEAR(winsorizedMean(values), 1.3, 1e-3);
}

TEST(WinsorizedMean, OfAFewLitPixelsBeforeAVoidIsNotBlack) {
  std::vector<float> values(1000, 0.0f);
  values[7] = 2.0f, values[8] = NAN;
  EXPECT_NEAR(winsorizedMean(values), 2.0 / 999.0, 1e-9);
}

using Warp = std::function<Vec3(float, float)>;
using Density = std::function<double(double)>;

// Expects unit directions with uniform azimuth. Each of `kBands` bands of z must hold as many as
// the density predicts, within five standard deviations.
void expectFollows(const Warp& warp, const Density& pdf, double zLow, double zHigh) {
  constexpr int kBands = 20, kDraws = 160000;
  std::vector<int> bands(kBands), sectors(8);
  Rng rng(streamKey(1, RandomStream::PixelSamples), 0);
  for (int i = 0; i < kDraws; ++i) {
    const float u = rng.next(), v = rng.next();
    const Vec3 d = warp(u, v);
    ASSERT_NEAR(length(d), 1.0f, 1e-5f);
    const double position = (double{d.z} - zLow) / (zHigh - zLow);
    ASSERT_GT(position, -1e-5);
    ASSERT_LT(position, 1.0 + 1e-5);
    ++bands[size_t(std::clamp(int(position * kBands), 0, kBands - 1))];
    ++sectors[size_t(std::clamp(int((std::atan2(d.y, d.x) / kPi + 1.0f) * 4.0f), 0, 7))];
  }
  for (int b = 0; b < kBands; ++b) {
    const double low = zLow + (zHigh - zLow) * b / kBands, step = (zHigh - zLow) / kBands / 100;
    double expected = 0.0;
    for (int k = 0; k < 100; ++k) expected += pdf(low + (k + 0.5) * step) * step;
    expected *= 2.0 * double{kPi} * kDraws;
    EXPECT_NEAR(bands[size_t(b)], expected, 5.0 * std::sqrt(expected)) << "band " << b;
  }
  for (const int n : sectors) EXPECT_NEAR(n, kDraws / 8.0, 5.0 * std::sqrt(kDraws / 8.0));
}

TEST(Sampling, DiskIsUniformAndKeepsStrata) {
  constexpr int kSide = 300;
  double inner = 0.0;
  Vec3 mean;
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      const Vec3 p = sampleDisk((float(i) + 0.5f) / kSide, (float(j) + 0.5f) / kSide);
      ASSERT_LE(length(p), 1.0f + 1e-6f);
      inner += length(p) < 0.5f ? 1.0 : 0.0;
      mean += p;
    }
  }
  EXPECT_NEAR(inner / (kSide * kSide), 0.25, 0.005);
  EXPECT_LT(length(mean) / (kSide * kSide), 1e-4f);
  EXPECT_EQ(sampleDisk(0.5f, 0.5f), Vec3());
  // Neighbours in the square stay neighbours on the disk.
  for (float u = 0.0f; u < 1.0f; u += 0.01f) {
    EXPECT_LT(length(sampleDisk(u, 0.3f) - sampleDisk(u + 0.01f, 0.3f)), 0.04f);
  }
}

TEST(Sampling, SeriesAreSineAndCosineOfAnEighthTurn) {
  for (int i = -1000; i <= 1000; ++i) {
    const float x = kPi / 4.0f * float(i) / 1000.0f;
    EXPECT_NEAR(sineOfEighth(x), std::sin(double{x}), 1e-7);
    EXPECT_NEAR(cosineOfEighth(x), std::cos(double{x}), 1e-7);
  }
}

TEST(Sampling, CosineHemisphere) {
  const Density pdf = [](double z) { return double{pdfCosineHemisphere(float(z))}; };
  EXPECT_NEAR(overSphere(pdf), 1.0, 1e-4);
  EXPECT_EQ(pdfCosineHemisphere(-0.5f), 0.0f);
  expectFollows(sampleCosineHemisphere, pdf, 0.0, 1.0);
}

TEST(Sampling, Sphere) {
  expectFollows(
      sampleSphere, [](double) { return 1.0 / (4.0 * double{kPi}); }, -1.0, 1.0);
}

TEST(Sampling, Cone) {
  for (const float cosHalf : {0.99f, 0.5f, 0.0f, -0.7f}) {
    const Density pdf = [&](double z) {
      return z >= double{cosHalf} ? 1.0 / (2.0 * double{kPi} * (1.0 - double{cosHalf})) : 0.0;
    };
    EXPECT_NEAR(overSphere(pdf), 1.0, 2e-3) << cosHalf;
    expectFollows([&](float u, float v) { return sampleCone(u, v, cosHalf); }, pdf, double{cosHalf},
                  1.0);
  }
}

TEST(Sampling, PowerCosine) {
  for (const float exponent : {0.0f, 1.0f, 5.0f, 60.0f}) {
    const Density pdf = [&](double z) { return double{pdfPowerCosine(float(z), exponent)}; };
    EXPECT_NEAR(overSphere(pdf), 1.0, 1e-3) << exponent;
    expectFollows([&](float u, float v) { return samplePowerCosine(u, v, exponent); }, pdf, 0.0,
                  1.0);
  }
  EXPECT_EQ(pdfPowerCosine(-0.1f, 2.0f), 0.0f);
}

TEST(Sampling, TriangleIsUniform) {
  constexpr int kSide = 300;
  double u = 0.0, v = 0.0, corner = 0.0;
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      const Barycentric b = sampleTriangle((float(i) + 0.5f) / kSide, (float(j) + 0.5f) / kSide);
      ASSERT_TRUE(b.u >= 0.0f && b.v >= 0.0f && b.u + b.v <= 1.0f + 1e-6f);
      u += double{b.u};
      v += double{b.v};
      corner += b.u > 0.5f ? 1.0 : 0.0;
    }
  }
  EXPECT_NEAR(u / (kSide * kSide), 1.0 / 3.0, 1e-3);
  EXPECT_NEAR(v / (kSide * kSide), 1.0 / 3.0, 1e-3);
  EXPECT_NEAR(corner / (kSide * kSide), 0.25, 0.005);
}

TEST(Sampling, PowerHeuristicSharesSumToOne) {
  for (const float a : {1e-6f, 0.3f, 1.0f, 50.0f, 1e6f}) {
    for (const float b : {1e-6f, 0.3f, 1.0f, 50.0f, 1e6f}) {
      EXPECT_NEAR(powerHeuristic(a, b) + powerHeuristic(b, a), 1.0f, 1e-6f);
    }
    EXPECT_EQ(powerHeuristic(a, 0.0f), 1.0f);
    EXPECT_EQ(powerHeuristic(0.0f, a), 0.0f);
  }
  EXPECT_GT(powerHeuristic(2.0f, 1.0f), 0.79f);  // squares: 4 / 5
  EXPECT_EQ(powerHeuristic(INFINITY, 1.0f), 1.0f);
}

// A guide table finds the same entry as the full search, to the last bit: in steep rows, rows that
// are zero at both ends, rows of one entry, and black rows.
TEST(Cdf, AGuideFindsTheSame) {
  Rng rng(1, 0);
  for (const size_t size : {1u, 2u, 100u, 2048u}) {
    for (const float steepness : {0.0f, 1.0f, 30.0f}) {
      std::vector<double> weights(size);
      for (size_t i = size / 4; i < size - size / 4; ++i)
        weights[i] = std::exp(double{steepness * rng.next()});
      if (steepness == 0.0f) std::ranges::fill(weights, 0.0);
      const std::vector<float> cdf = makeCdf<float>(weights);
      std::vector<uint32_t> guide;
      appendGuide<float>(cdf, guide);
      ASSERT_EQ(guide.size(), kGuideSteps);
      for (int k = 0; k < 20000; ++k) {
        const float u = k < 129 ? std::min(float(k) / 128.0f, 0x1.fffffep-1f) : rng.next();
        float a = u, b = u;
        ASSERT_EQ(sampleCdf<float>(cdf, a), sampleCdf<float>(cdf, guide, b)) << u;
        ASSERT_EQ(a, b);
      }
    }
  }
}

}  // namespace
}  // namespace bnvpl
