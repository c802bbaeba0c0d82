// Sample allocation: where samples go, and that the image stays unbiased.
#include "tools/render/tile/allocation/sample_allocation.h"

#include <gtest/gtest.h>

#include "tests/support/pipeline.h"

namespace bnvpl::test {
namespace {

TEST(SampleAllocation, SamplesGrowWithDeviationAndFallWithTheRootOfCost) {
  EXPECT_EQ(samplesFor(4.0, 1.0, 0.01, 1, 1000), 20u);
  EXPECT_EQ(samplesFor(16.0, 1.0, 0.01, 1, 1000), 40u);
  EXPECT_EQ(samplesFor(4.0, 4.0, 0.01, 1, 1000), 10u);
  EXPECT_EQ(samplesFor(4.0, 1.0, 0.01, 1, 7), 7u);
  EXPECT_EQ(samplesFor(0.0, 1.0, 0.01, 3, 7), 3u);
}

// The samples of a pixel affect only the number of samples of the other parity.
TEST(SampleAllocation, APixelDoesNotDecideOnItsOwnSamples) {
  const TileLayout tile{64, 8};
  const SampleAllocation allocation{0.01, 0.0, 1e6};
  std::vector<PixelMoments> pixels(64);
  for (PixelMoments& p : pixels) {
    p.add(Vec3(1.0f)), p.add(Vec3(1.2f));
    p.light = Vec3(1.1f);
  }
  const auto samples = [&] { return samplesByParity(pixels, tile, 0.01, allocation, 1, 1000); };
  const auto before = samples();
  pixels[27].add(Vec3(40.0f));  // a pixel of parity 0
  EXPECT_EQ(samples()[0], before[0]);
  EXPECT_GT(samples()[1], 2 * before[1]);
}

// Doubling the light quarters the relative variance in dark tiles and halves it in bright ones.
TEST(SampleAllocation, VarianceIsRelativeAndInBrightTilesHalfWayToAbsolute) {
  const SampleAllocation allocation{0.01, 0.0, 3.0};
  EXPECT_DOUBLE_EQ(allocation.relative(1.0, Vec3(0.25f)),
                   4.0 * allocation.relative(1.0, Vec3(0.5f)));
  EXPECT_DOUBLE_EQ(allocation.relative(1.0, Vec3(2.0f)),
                   2.0 * allocation.relative(1.0, Vec3(4.0f)));
  EXPECT_EQ(SampleAllocation{}.relative(1.0, Vec3{}), 0.0);
}

// Light comes through a door, and direct light from an emitter hidden from most of the film.
TEST(SampleAllocation, ImagesKeepTheirMean) {
  World world("veach-door/scene.toml");
  world.scene.film = {48, 27};
  const VplTable lit = litVpls(world, {{"count", "600"}});
  double off = 0.0, on = 0.0;
  for (uint64_t seed = 1; seed <= 6; ++seed) {
    const Given options{{"spp", "8"}, {"seed", typed(seed)}};
    const auto meanWith = [&](const char* allocate) {
      const FilmStats s = renderVpls(world, lit, with(options, {{"allocate", allocate}})).stats;
      return s.direct + s.indirect;
    };
    off += meanWith("off"), on += meanWith("on");
  }
  EXPECT_NEAR(on / off, 1.0, 0.01);
}

}  // namespace
}  // namespace bnvpl::test
