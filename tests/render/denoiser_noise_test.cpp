// --for-denoiser: the noise of neighbouring pixels is independent, at little more variance.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/render/lit_rooms.h"
#include "tests/support/pipeline.h"

namespace bnvpl::test {
namespace {

constexpr int kWidth = 96, kHeight = 72;

struct Noise {
  double variance = 0.0;           // mean square of the difference of two seeds
  double along = 0.0, down = 0.0;  // correlation of that of pixels side by side, and above another
};
Noise noiseOf(const World& world, const VplTable& lit, const Given& options) {
  std::vector<double> difference(size_t{kWidth} * kHeight);
  for (const auto& [seed, sign] : {std::pair{"11", 1.0}, {"12", -1.0}}) {
    const Image image = renderVpls(world, lit, with(options, {{"seed", seed}})).image;
    for (const char* channel : {"R", "G", "B"}) {
      const std::vector<float>& values = *image.find(channel);
      for (size_t i = 0; i < values.size(); ++i) difference[i] += sign * double{values[i]} / 3.0;
    }
  }
  Noise noise;
  for (const double d : difference) noise.variance += d * d / double(difference.size());
  const auto correlation = [&](int dx, int dy) {
    double sum = 0.0;
    for (int y = 0; y + dy < kHeight; ++y) {
      for (int x = 0; x + dx < kWidth; ++x)
        sum += difference[size_t(y * kWidth + x)] * difference[size_t((y + dy) * kWidth + x + dx)];
    }
    return sum / ((kWidth - dx) * (kHeight - dy) * noise.variance);
  };
  noise.along = correlation(1, 0), noise.down = correlation(0, 1);
  return noise;
}

TEST(DenoiserNoise, IsIndependentBetweenPixels) {
  Scene scene = loadScene(fs::path(BNVPL_SCENES_DIR) / "u-shape/scene.toml");
  scene.film = {kWidth, kHeight};
  const World world(std::move(scene));
  const VplTable lit = litVpls(world);
  const Noise shared = noiseOf(world, lit, {{"spp", "4"}}),
              alone = noiseOf(world, lit, {{"spp", "4"}, {"for-denoiser", "on"}});
  EXPECT_LT(std::abs(alone.along), 0.05);
  EXPECT_LT(std::abs(alone.down), 0.05);
  EXPECT_GT(shared.along + shared.down, 2.0 * (alone.along + alone.down))
      << "path reuse correlates";
  EXPECT_LT(alone.variance, 1.2 * shared.variance);
  RecordProperty("noise", std::to_string(shared.along) + " " + std::to_string(shared.down) + " " +
                              std::to_string(alone.along) + " " + std::to_string(alone.down) +
                              " ratio " + std::to_string(alone.variance / shared.variance));
}

}  // namespace
}  // namespace bnvpl::test
