#include <gtest/gtest.h>

#include "tests/support/gather_checks.h"
#include "tests/transport/plain_scene.h"

namespace bnvpl::test {
namespace {

// The light of clusters is that of one VPL, and rays of few receivers decide on the visibility.
TEST(IlluminationCut, HasTheEnergyOfAllVpls) { expectEnergyOfAll("illumination-cut", 0.03, 2); }

TEST(IlluminationCut, HasTheEnergyInFurnaceAndOfOneBounce) {
  expectEnergyInFurnaceAndOfOneBounce("illumination-cut", 0.02);
}

TEST(IlluminationCut, WithoutToleratedErrorIsTheSumOverAll) {
  expectSumOverAll("illumination-cut", {{"error", "0"}});
}

RenderResult shown(const GatherCase& c, const Given& options) {
  return renderVpls(
      c.world, c.lit,
      with(with(kPlainRender, {{"gather", "illumination-cut"}, {"only", "indirect"}}), options));
}

TEST(IlluminationCut, ASmallerErrorTakesMorePairs) {
  const GatherCase& c = *gatherCases().back();
  EXPECT_GT(shown(c, {{"error", "0.005"}}).stats.cut,
            1.5 * shown(c, {{"error", "0.05"}}).stats.cut);
}

// Where receivers agree on the visibility of a pair, none of them traces a ray for it. Groups of
// more than eight receivers share pairs on films that are not small.
TEST(IlluminationCut, SharedVisibilitySavesRays) {
  const GatherCase c("cornell/scene.toml", {160, 120}, {{"count", "1000"}}, {{"photons", "100k"}});
  const RenderResult shared = shown(c, {{"error", "0.1"}, {"spp", "1"}});
  const RenderResult each = shown(c, {{"error", "0.1"}, {"spp", "1"}, {"pair-rays", "0"}});
  EXPECT_LT(shared.stats.shadowRays, 0.95 * each.stats.shadowRays);
  EXPECT_GT(shared.stats.own[0], 1.0);
  EXPECT_EQ(each.stats.own[0], 0.0);
  EXPECT_NEAR(shared.stats.indirect / each.stats.indirect, 1.0, 0.03);
}

// Where no receiver sees a VPL, the image is black, and what they would get without shadows tells
// which error does not count.
TEST(IlluminationCut, HiddenVplsNeedNoMorePairsThanSeenOnes) {
  Scene scene;
  addSquare(scene, {-2, 0, 0}, {4, 0, 0}, {0, 0, -4}, lambert(Vec3(0.7f)));     // floor
  addSquare(scene, {-9, -9, -5}, {18, 0, 0}, {0, 18, 0}, lambert(Vec3(0.7f)));  // wall
  finishScene(scene);
  scene.camera.position = {0, 3.0f, 2.0f};
  scene.camera.forward = normalize(Vec3{0, -3.0f, -3.5f});
  scene.camera.up = cross(scene.camera.right, scene.camera.forward);
  scene.film = {32, 32};
  const World world(std::move(scene));
  VplTable lit;
  Rng rng(3, 0);
  for (int i = 0; i < 300; ++i) {
    lit.position.push_back({4.0f * rng.next() - 2.0f, 1.0f + rng.next(), -7.0f});
    lit.normal.push_back({0, 0, 1});
    lit.albedo.push_back(Vec3(0.7f)), lit.flux.push_back(Vec3(1.0f));
    lit.firstBounceFlux.push_back(Vec3{});
    lit.radius.push_back(0.1f);
  }
  lit.emitPosition = lit.position, lit.emitNormal = lit.normal;
  const RenderResult result = renderVpls(
      world, lit, with(kPlainRender, {{"gather", "illumination-cut"}, {"only", "indirect"}}));
  EXPECT_EQ(result.stats.indirect, 0.0);
  ASSERT_EQ(result.filmCounts[0].name, "plan_pairs");
  EXPECT_LT(result.filmCounts[0].value, 0.25 * double(lit.size()) * 32 * 32);
}

}  // namespace
}  // namespace bnvpl::test
