#include <gtest/gtest.h>

#include "tests/support/pipeline.h"

namespace bnvpl::test {
namespace {

// Mean indirect light over fresh sets of VPLs from the lights, and its standard error.
struct MeanLight {
  double mean = 0.0, error = 0.0;
};
std::vector<VplTable> setsOf(const World& world) {
  std::vector<VplTable> sets;
  for (uint64_t seed = 1; seed <= 12; ++seed)
    sets.push_back(
        placeVpls(world, {{"method", "light"}, {"count", "2000"}, {"seed", typed(seed)}}).table);
  return sets;
}
MeanLight overSets(const World& world, const std::vector<VplTable>& sets, const Given& options) {
  double sum = 0.0, squares = 0.0;
  for (size_t k = 0; k < sets.size(); ++k) {
    const double light =
        indirectByVpls(world, sets[k], with({{"spp", "1"}, {"seed", typed(k + 1)}}, options));
    sum += light, squares += light * light;
  }
  const double n = double(sets.size()), mean = sum / n;
  return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean) / (n - 1.0))};
}

// The bound moves light between VPLs and rays, and its mean over sets of VPLs stays that of paths.
TEST(KolligKeller, IsUnbiasedWhateverTheBound) {
  World world("cornell/scene.toml");
  world.scene.film = {16, 16};
  const double path = indirectByPaths(world, {{"spp", "2048"}});
  const std::vector<VplTable> sets = setsOf(world);
  const std::vector<std::pair<const char*, const char*>> bounds{
      {"point", "0.5"}, {"point", "2"}, {"point", "8"}, {"disk", "2"}, {"yuksel", "2"}};
  for (const auto& [light, clamp] : bounds) {
    const MeanLight ours = overSets(
        world, sets, {{"compensate", "kollig-keller"}, {"clamp", clamp}, {"light", light}});
    EXPECT_NEAR(ours.mean, path, 3.0 * ours.error + 0.003 * path) << light << clamp;
    EXPECT_LT(ours.error, 0.02 * path);
  }
  const MeanLight none = overSets(world, sets, {{"compensate", "none"}, {"clamp", "8"}});
  EXPECT_LT(none.mean, 0.9 * path);
}

// In the furnace every surface has the same light; the other scene has one bounce between two
// patches.
TEST(KolligKeller, KeepsTheEnergy) {
  for (const char* name : {"furnace/scene.toml", "test/one-bounce.toml"}) {
    World world(name);
    world.scene.film = {16, 12};
    const double path = indirectByPaths(world, {{"spp", "1024"}});
    const std::vector<VplTable> sets = setsOf(world);
    const MeanLight ours = overSets(world, sets, {{"compensate", "kollig-keller"}, {"clamp", "8"}});
    EXPECT_NEAR(ours.mean, path, 3.0 * ours.error + 0.003 * path) << name;
    EXPECT_LT(ours.error, 0.02 * path) << name;
    const MeanLight none = overSets(world, sets, {{"compensate", "none"}, {"clamp", "8"}});
    EXPECT_LT(none.mean, 0.98 * ours.mean) << name;
  }
}

// Paths go on where the bound removes light, from more vertices if it removes more.
TEST(KolligKeller, CountsTheRaysThatGoOn) {
  World world("cornell/scene.toml");
  world.scene.film = {16, 16};
  const VplTable lit = placeVpls(world, {{"method", "light"}, {"count", "200"}}).table;
  const auto continued = [&](const char* clamp) {
    const Given options{{"compensate", "kollig-keller"}, {"clamp", clamp}, {"only", "indirect"}};
    return renderVpls(world, lit, with(kPlainRender, options)).stats.own[0];
  };
  EXPECT_EQ(continued("0"), 0.0);
  EXPECT_GT(continued("1"), 0.0);
  EXPECT_GT(continued("4"), 4.0 * continued("1"));
}

TEST(KolligKeller, AllVplsHaveOneSize) {
  World world("cornell/scene.toml");
  world.scene.film = {16, 16};
  VplTable lit = litVpls(world, {{"count", "200"}}, {{"photons", "50k"}}, {{"count", "4k"}});
  const auto shown = [&](const char* compensate) {
    return indirectByVpls(world, lit, {{"compensate", compensate}, {"clamp", "6"}});
  };
  const double before = shown("kollig-keller"), none = shown("none");
  // The mean area is the same, but each VPL's own is not.
  for (size_t i = 0; i + 1 < lit.size(); i += 2) {
    const float r2 = lit.radius[i] * lit.radius[i] + lit.radius[i + 1] * lit.radius[i + 1];
    lit.radius[i] = std::sqrt(0.1f * r2), lit.radius[i + 1] = std::sqrt(0.9f * r2);
  }
  const double ours = std::fabs(shown("kollig-keller") / before - 1.0);
  EXPECT_LT(ours, 2e-3);  // light sampling at vertices asks for the radii, too
  EXPECT_GT(std::fabs(shown("none") / none - 1.0), 4.0 * ours);
}

}  // namespace
}  // namespace bnvpl::test
