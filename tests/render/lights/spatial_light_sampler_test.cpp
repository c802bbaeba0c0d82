// Vertices far from the camera sample the lights that the VPLs around them see.
#include "transport/direct_light/spatial_light_sampler.h"

#include <gtest/gtest.h>

#include "tests/render/lit_rooms.h"
#include "tests/support/pipeline.h"
#include "tests/support/z_test.h"

namespace bnvpl::test {
namespace {

constexpr uint32_t kHidden = 1200;  // point lights above the ceiling

VplTable litBy(const World& world) {
  return litVpls(world, {{"count", "150"}}, {{"photons", "100k"}, {"emit-points", "1"}},
                 {{"count", "3k"}});
}

SpatialLightSampler learned(const World& world, const VplTable& vpls) {
  return {world.accel, world.lights, vpls.position, vpls.normal, vpls.radius, 7, {}};
}

TEST(SpatialLightSampler, FewRaysGoToHiddenLights) {
  const World world(bulbs(kHidden));
  const VplTable vpls = keptVpls(world, {{"count", "150"}}, {{"count", "3k"}});
  const SpatialLightSampler lights = learned(world, vpls);
  Rng rng(1, 0);
  size_t seen = 0;
  constexpr size_t kDraws = 4000;
  for (size_t k = 0; k < kDraws; ++k) {
    const size_t i = k % vpls.size();
    const LearnedStrata strata = lights.at(vpls.position[i], vpls.normal[i]);
    ASSERT_NE(strata.all, nullptr);
    float u = rng.next();
    const LightPoint place = strata.all->samplePoint(strata.pick(u), {u, rng.next()});
    seen += place.light < 3;
    ASSERT_GT(strata.density(place), 0.0f);
  }
  EXPECT_GT(double(seen), 0.5 * kDraws);
}

TEST(SpatialLightSampler, ProbabilitiesOfAPlaceSumToOne) {
  const World world(manyLights());
  const VplTable vpls = keptVpls(world, {{"count", "150"}}, {{"count", "3k"}});
  const SpatialLightSampler lights = learned(world, vpls);
  for (size_t i = 0; i <= vpls.size(); ++i) {  // the last lies far from all VPLs
    const LearnedStrata strata = i < vpls.size()
                                     ? lights.at(vpls.position[i], vpls.normal[i])
                                     : lights.at(world.scene.bounds.upper * 9.0f, {0, 1, 0});
    ASSERT_NE(strata.all, nullptr);
    double sum = 0.0;
    for (uint32_t s = 0; s < strata.all->size(); ++s) sum += double{strata.probability(s)};
    EXPECT_NEAR(sum, 1.0, 1e-4) << i;
  }
}

TEST(SpatialLightSampler, OneLightLeavesNothingToChoose) {
  Scene scene = bulbs(0);
  scene.lights.resize(1);
  const World world(std::move(scene));
  const VplTable vpls = keptVpls(world, {{"count", "50"}}, {{"count", "1k"}});
  EXPECT_EQ(learned(world, vpls).at(vpls.position[0], vpls.normal[0]).all, nullptr);
}

// Point lights that light no visible surface change nothing, and hardly the noise.
TEST(SpatialLightSampler, NearFieldRaysFindTheFewVisibleLights) {
  const World few(bulbs(0)), many(bulbs(kHidden));
  const VplTable lit = litBy(few);
  const auto by = [&](const World& world) -> Render {
    return [&](uint64_t seed) {
      return renderVpls(world, lit,
                        {{"only", "indirect"},
                         {"spp", "4"},
                         {"gather", "all"},
                         {"fireflies", "keep"},
                         {"seed", typed(seed)}})
          .image;
    };
  };
  EXPECT_TRUE(sameExpectation(by(many), by(few)));
  EXPECT_LT(noiseOf(by(many)), 2.0 * noiseOf(by(few)));  // 7 times if lights were sampled by power
}

TEST(SpatialLightSampler, GuidedPathsHaveThePathTracersImage) {
  const World world(manyLights());
  const VplTable lit = litBy(world);
  EXPECT_TRUE(sameExpectation(
      [&](uint64_t seed) {
        return renderWithout(world, "path", {{"spp", "64"}, {"seed", typed(seed)}}).image;
      },
      [&](uint64_t seed) {
        return renderVpls(world, lit,
                          {{"integrator", "guided"}, {"spp", "4"}, {"seed", typed(100 + seed)}})
            .image;
      }));
}

// Points seen over a near-specular lobe see other lights than their tile, which covers all cells.
TEST(SpatialLightSampler, ShadingPointsBehindNearSpecularLobesSampleTheirOwnLights) {
  const World world(cellsBeforeMetal(/*seesMetal=*/true));
  const VplTable lit = litVpls(world, {{"count", "800"}});
  const auto direct = [&](const Given& options) -> Render {
    return [&, options](uint64_t seed) {
      return renderVpls(world, lit,
                        with({{"only", "direct"},
                              {"spp", "4"},
                              {"direct-samples", "4"},
                              {"fireflies", "keep"},
                              {"seed", typed(seed)}},
                             options))
          .image;
    };
  };
  const Render learned = direct({{"integrator", "guided"}}), each = direct({{"direct", "each"}});
  EXPECT_TRUE(sameExpectation(learned, each));
  EXPECT_LT(noiseOf(learned), 2.0 * noiseOf(each));  // 3.5 times with the tile's lights
}

TEST(SpatialLightSampler, PathsFromVplsFindTheFewVisibleLights) {
  const World few(bulbs(0)), many(bulbs(kHidden));
  const VplTable vpls = keptVpls(few, {{"count", "150"}}, {{"count", "3k"}});
  const auto fluxes = [&](const World& world, const char* seed) {
    return lightVpls(world, vpls,
                     {{"method", "paths"}, {"points", "64"}, {"emit-points", "0"}, {"seed", seed}})
        .table;
  };
  const VplTable a = fluxes(few, "1"), b = fluxes(many, "2"), c = fluxes(many, "3");
  double right = 0.0, found = 0.0, squares = 0.0, all = 0.0;
  for (size_t i = 0; i < vpls.size(); ++i) {
    // Such VPLs lie on top of the area light, and their disks reach the outside of the ceiling.
    if (vpls.normal[i].y > 0.9f && vpls.position[i].y > few.scene.bounds.upper.y * 0.9f) continue;
    right += double{mean(a.flux[i])}, found += double{mean(b.flux[i])};
    squares += std::pow(double{mean(b.flux[i])} - double{mean(c.flux[i])}, 2);
    all += std::pow(double{mean(a.flux[i])}, 2);
  }
  EXPECT_NEAR(found / right, 1.0, 0.05);
  EXPECT_LT(std::sqrt(squares / all), 0.25);
}

}  // namespace
}  // namespace bnvpl::test
