#include <gtest/gtest.h>

#include "tests/support/gather_checks.h"

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

}  // namespace
}  // namespace bnvpl::test
