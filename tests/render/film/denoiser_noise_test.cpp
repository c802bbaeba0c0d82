// --for-denoiser: the noise of neighbouring pixels is independent, at little more variance.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/render/lit_rooms.h"
#include "tests/support/pipeline.h"

namespace bnvpl::test {
namespace {

constexpr int kWidth = 96, kHeight = 72;

struct Noise {
  double variance = 0.0;           // mean square of the differences of two seeds
  double along = 0.0, down = 0.0;  // correlation of those of pixels side by side, and above another
};

// Difference of the images of two seeds, mean of the channels. A few pixels along the edges of the
// light would decide its correlation: none counts as more than twice the median.
std::vector<double> differenceOf(const World& world, const VplTable& lit, const Given& options,
                                 int seed) {
  std::vector<double> difference(size_t{kWidth} * kHeight);
  for (const auto& [s, sign] : {std::pair{seed, 1.0}, {seed + 1, -1.0}}) {
    const Given seeded = with(with({{"spp", "4"}}, options), {{"seed", std::to_string(s)}});
    const Image image = renderVpls(world, lit, seeded).image;
    for (const char* channel : {"R", "G", "B"}) {
      const std::vector<float>& values = *image.find(channel);
      for (size_t i = 0; i < values.size(); ++i) difference[i] += sign * double{values[i]} / 3.0;
    }
  }
  std::vector<double> magnitudes(difference);
  for (double& m : magnitudes) m = std::abs(m);
  const auto middle = magnitudes.begin() + std::ptrdiff_t(magnitudes.size() / 2);
  std::ranges::nth_element(magnitudes, middle);
  for (double& d : difference) d = std::clamp(d, -2.0 * *middle, 2.0 * *middle);
  return difference;
}

// Means over pairs of seeds.
Noise noiseOf(const World& world, const VplTable& lit, const Given& options, int pairs) {
  Noise noise;
  for (int pair = 0; pair < pairs; ++pair) {
    const std::vector<double> difference = differenceOf(world, lit, options, 2 * pair + 1);
    const auto covariance = [&](int dx, int dy) {
      double sum = 0.0;
      for (int y = 0; y + dy < kHeight; ++y) {
        for (int x = 0; x + dx < kWidth; ++x)
          sum +=
              difference[size_t(y * kWidth + x)] * difference[size_t((y + dy) * kWidth + x + dx)];
      }
      return sum / ((kWidth - dx) * (kHeight - dy));
    };
    const double variance = covariance(0, 0);
    noise.variance += variance / pairs;
    noise.along += covariance(1, 0) / variance / pairs;
    noise.down += covariance(0, 1) / variance / pairs;
  }
  return noise;
}

TEST(DenoiserNoise, IsIndependentBetweenPixels) {
  const World world(room(kWidth, kHeight));
  const VplTable lit = litVpls(world, {{"count", "400"}});
  const Given forDenoiser{{"for-denoiser", "on"}};
  const Noise shared = noiseOf(world, lit, {}, 3), alone = noiseOf(world, lit, forDenoiser, 3);
  EXPECT_LT(std::abs(alone.along), 0.05);
  EXPECT_LT(std::abs(alone.down), 0.05);
  EXPECT_LT(alone.variance, 1.2 * shared.variance);
}

// All of this integrator's indirect light comes from rays that neighbouring pixels reuse.
TEST(DenoiserNoise, ReusedRaysCorrelatePixels) {
  const World world(room(kWidth, kHeight));
  const VplTable lit = litVpls(world, {{"count", "400"}});
  const Given guided{{"integrator", "guided"}};
  const Noise shared = noiseOf(world, lit, guided, 1),
              alone = noiseOf(world, lit, with(guided, {{"for-denoiser", "on"}}), 1);
  EXPECT_GT(shared.along + shared.down, 0.15);
  EXPECT_LT(std::abs(alone.along), 0.05);
  EXPECT_LT(std::abs(alone.down), 0.05);
}

}  // namespace
}  // namespace bnvpl::test
