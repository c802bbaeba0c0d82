// Sample allocation: where samples go, and that the image stays unbiased.
#include "tools/render/tile/allocation/sample_allocation.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "tests/support/pipeline.h"
#include "tools/render/tile/direct/direct_samples.h"
#include "transport/camera.h"

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
  const auto samples = [&] {
    return samplesByParity(pixels, tile, 1.0f, 0.01, allocation, 1, 1000);
  };
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

struct Light {
  float direct = 0.0f, indirect = 0.0f;
};

// The marginal cost that a pilot finds where light(sample index) is what each sample has.
double marginalCost(FilterKind filter, ShownLight shown,
                    const std::function<Light(size_t index)>& light) {
  World world("cornell/scene.toml");
  world.scene.film = {64, 64};
  return findAllocation(world.scene, PixelFilter(filter, 2.0f), 1, 16, shown, {},
                        [&](const TileSamples& tile) {
                          for (size_t i = 0; i < tile.samples.size(); ++i) {
                            CameraSample& s = tile.samples[i];
                            const Light found = light(i);
                            s.radiance.direct = Vec3(found.direct);
                            s.radiance.indirect = Vec3(found.indirect);
                          }
                          return 1.0;
                        })
      .marginalCost;
}

TEST(SampleAllocation, SignsOfThePixelFilterAreNoNoise) {
  const auto even = [](size_t) { return Light{1.0f}; };
  EXPECT_EQ(marginalCost(FilterKind::Mitchell, ShownLight::All, even), 0.0);
  const auto noisy = [](size_t i) { return Light{i / 64 % 2 ? 1.2f : 1.0f}; };
  const double box = marginalCost(FilterKind::Box, ShownLight::All, noisy),
               mitchell = marginalCost(FilterKind::Mitchell, ShownLight::All, noisy);
  EXPECT_GT(box, 0.0);
  const double factor{PixelFilter(FilterKind::Mitchell, 2.0f).squaredWeight()};
  EXPECT_GT(factor, 1.1);
  EXPECT_NEAR(mitchell / box, factor, 0.05 * factor);
}

// Light in the negative lobes is that of neighbours. Pilots in which it counts too often take the
// difference of pixels for noise. One of 16 samples of an image lies there.
TEST(SampleAllocation, PilotsLieInNegativeLobesAsOftenAsTheImageAndHaveNoWeights) {
  World world("cornell/scene.toml");
  const Film film = world.scene.film = {64, 64};
  const PixelFilter filter(FilterKind::Mitchell, 2.0f);
  std::atomic<size_t> negative = 0, all = 0, weighted = 0;
  findAllocation(world.scene, filter, 1, 16, ShownLight::All, {}, [&](const TileSamples& tile) {
    for (size_t i = 0; i < tile.samples.size(); ++i) {
      const CameraSample& s = tile.samples[i];
      const RasterPoint at = projectToFilm(world.scene.camera, film, s.origin + s.direction);
      const uint32_t p = static_cast<uint32_t>(i) % tile.pixels;
      const float x = at.x * 64.0f - float(tile.pixelX(p)) - 0.5f,
                  y = at.y * 64.0f - float(tile.pixelY(p)) - 0.5f;
      negative += filter.density(x, y) < 0.0f;
      weighted += tile.weighted || s.weight != 1.0f;
    }
    all += tile.samples.size();
    return 1.0;
  });
  EXPECT_NEAR(double(negative) / double(all), 1.0 / 16.0, 0.01);
  EXPECT_EQ(weighted, 0u);
}

// The mean of several direct samples, each with a weight of its own, has no weight to divide by.
TEST(SampleAllocation, DirectSamplesOfPilotsHaveNoWeights) {
  Scene scene = loadScene(fs::path(BNVPL_SCENES_DIR) / "furnace/scene.toml");
  scene.film = {64, 64};
  const World world(std::move(scene));  // every sample sees the same emission
  const PixelFilter mitchell(FilterKind::Mitchell, 2.0f);
  const DirectSamples direct(world.accel, world.lights, mitchell, nullptr, nullptr, 5, true);
  const auto costWith = [&](bool weighted) {
    return findAllocation(world.scene, mitchell, 1, 16, ShownLight::Direct, {},
                          [&](TileSamples tile) {
                            tile.weighted = weighted;
                            const std::vector<SpecularPath> paths(tile.samples.size());
                            direct.render(tile, paths, nullptr, {}, 1.0, {});
                            for (CameraSample& s : tile.samples)
                              s.radiance.direct = s.radiance.emission;
                            return 1.0;
                          })
        .marginalCost;
  };
  EXPECT_EQ(costWith(false), 0.0);
  EXPECT_GT(costWith(true), 0.01);
}

// Photons of a pixel have no weight, unlike the rest of a sample's indirect light.
TEST(SampleAllocation, LightOfTheWholePixelHasNoWeight) {
  RadianceSample sample;
  sample.pixelLight = Vec3(3.0f);
  for (const float weight : {-1.25f, 1.0f, 1.5f}) {
    sample.indirect = sample.pixelLight + Vec3(2.0f * weight);
    EXPECT_FLOAT_EQ(mean(unweightedIndirect(sample, weight)), 5.0f) << weight;
  }
}

// The median light is that of the tiles that have light, as before a black background.
TEST(SampleAllocation, BlackTilesDoNotEndIt) {
  World world("cornell/scene.toml");
  world.scene.film = {64, 64};
  const auto found = [&](uint32_t litColumns) {
    return findAllocation(world.scene, {}, 1, 16, ShownLight::All, {},
                          [&](const TileSamples& tile) {
                            for (size_t i = 0; i < tile.samples.size(); ++i) {
                              tile.samples[i].radiance.direct = Vec3(tile.x >= litColumns ? 0.0f
                                                                     : i / 64 % 2         ? 1.2f
                                                                                          : 1.0f);
                            }
                            return 1.0;
                          });
  };
  const SampleAllocation all = found(64), few = found(16);
  EXPECT_GT(few.marginalCost, 0.0);
  EXPECT_DOUBLE_EQ(few.medianSquared, all.medianSquared);
  EXPECT_EQ(found(0).marginalCost, 0.0);
}

// A camera path that ends on a lamp has no indirect light, by which the number of direct samples is
// chosen. So its emission counts only where this number is given.
TEST(SampleAllocation, CameraPathsThatDecideOnDirectSamplesAreNotAmongThem) {
  const World world("furnace/scene.toml");
  const auto directWith = [&](unsigned count, float emission) {
    const DirectSamples direct(world.accel, world.lights, {}, nullptr, nullptr, count, false);
    std::vector<CameraSample> samples(64);
    TileSamples tile{{.pixels = 64, .width = 8}, samples};
    std::vector<SpecularPath> paths(64);
    for (SpecularPath& path : paths) path.firstSegmentEmission = Vec3(emission);
    direct.render(tile, paths, nullptr, {.variance = 1.0, .light = {}}, 1.0, {});
    return double{mean(samples[27].radiance.direct)};
  };
  EXPECT_EQ(directWith(0, 100.0f), directWith(0, 0.0f));
  EXPECT_NEAR(directWith(4, 100.0f) - directWith(4, 0.0f), 100.0 / 5.0, 1e-4);
}

TEST(SampleAllocation, OnlyShownLightCounts) {
  const auto noisyDirect = [](size_t i) { return Light{static_cast<float>(i / 64), 1.0f}; };
  EXPECT_GT(marginalCost(FilterKind::Box, ShownLight::All, noisyDirect), 0.0);
  EXPECT_EQ(marginalCost(FilterKind::Box, ShownLight::Indirect, noisyDirect), 0.0);
}

TEST(SampleAllocation, SamplesThatAreNoNumbersAreBlack) {
  const auto broken = [](float light) {
    return [=](size_t i) { return Light{i == 70 ? light : 1.0f}; };
  };
  const double black = marginalCost(FilterKind::Box, ShownLight::All, broken(0.0f));
  EXPECT_GT(black, 0.0);
  EXPECT_EQ(marginalCost(FilterKind::Box, ShownLight::All, broken(NAN)), black);
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
