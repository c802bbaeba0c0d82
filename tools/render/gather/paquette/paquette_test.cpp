#include "tests/support/gather_checks.h"

namespace bnvpl::test {
namespace {

double nodes(const Given& options) {
  return meanOfLayer(
      gatherCases().front()->indirect("paquette", with({{"layers", "octreenodes"}}, options), 1),
      "octreenodes");
}

TEST(Paquette, HasAboutTheEnergyOfAllVpls) {
  expectEnergyOfAll("paquette", 0.03, 2);
  expectEnergyInFurnaceAndOfOneBounce("paquette", 0.02);
}

TEST(Paquette, WithoutErrorItIsTheSumOverAll) {
  expectSumOverAll("paquette", {{"error", "0"}});
  expectSumOverAll("paquette", {{"error", "0"}}, {{"light", "spherical"}, {"clamp", "2"}});
}

// Nothing hides a VPL in a convex room, where the published method is exact, too.
TEST(Paquette, WithoutErrorAndShadowsItIsTheSumOverAllUnhidden) {
  World world("furnace/scene.toml");
  world.scene.film = {24, 24};
  const VplTable lit = litVpls(world, {{"count", "300"}}, {}, {{"count", "6k"}});
  const auto image = [&](const Given& options) {
    return renderVpls(world, lit, with(with(kPlainRender, {{"only", "indirect"}}), options)).image;
  };
  const Image all = image({}),
              own = image({{"gather", "paquette"}, {"error", "0"}, {"shadows", "none"}});
  const auto &x = *all.find("G"), &y = *own.find("G");
  for (size_t i = 0; i < x.size(); ++i) ASSERT_NEAR(y[i], x[i], 1e-4f * x[i]) << i;
}

// Light passes through the blocks of the box.
TEST(Paquette, WithoutShadowsItIsTooBright) {
  const GatherCase& c = *gatherCases().front();
  const double all = meanOf(c.indirect("all", {}, 1));
  EXPECT_GT(meanOf(c.indirect("paquette", {{"shadows", "none"}}, 1)), 1.05 * all);
}

TEST(Paquette, ASmallerErrorOpensMoreNodes) {
  EXPECT_GT(nodes({{"error", "0.01"}}), 1.3 * nodes({{"error", "0.05"}}));
}

}  // namespace
}  // namespace bnvpl::test
