#include <gtest/gtest.h>

#include "tests/support/grey_cube.h"

namespace bnvpl::test {
namespace {

Given fromLights(uint64_t vpls) { return {{"method", "light"}, {"count", typed(vpls)}}; }

double totalOf(const std::vector<Vec3>& column, size_t channel) {
  double sum = 0.0;
  for (const Vec3 v : column) sum += double{v[channel]};
  return sum;
}

// In a closed room every photon hits a wall, and the first hit reflects exactly half of its flux.
TEST(PlaceLight, CarriesThePowerOfTheFirstHits) {
  const World world = greyCube({{3, 2, 1}});
  const PlaceResult placed = placeVpls(world, with(fromLights(5000), {{"light-depth", "1"}}));
  ASSERT_EQ(placed.table.stage, VplStage::Lit);
  EXPECT_EQ(placed.paths, 5000u);
  for (size_t c = 0; c < 3; ++c) {
    const double expected = 0.5 * double{world.lights.totalPower()[c]};
    EXPECT_NEAR(totalOf(placed.table.flux, c), expected, 1e-4 * expected);
    EXPECT_NEAR(totalOf(placed.table.firstBounceFlux, c), expected, 1e-4 * expected);
  }
}

// All hits together reflect rho / (1 - rho) = 1 times the power, with a relative deviation of
// sqrt(1/2 / paths); first hits reflect rho = 1/2. Both hold for each of two lights of very
// different power.
TEST(PlaceLight, CarriesThePowerOfEachLight) {
  const World world = greyCube({{1, 0, 0}, {0, 0, 0.04f}});
  const PlaceResult placed = placeVpls(world, fromLights(200000));
  const auto paths = double(placed.paths);
  for (const size_t c : {0u, 2u}) {
    const double power = double{world.lights.power(c / 2)[c]},
                 share = double{world.lights.pickProbability(c / 2)};
    // The number of photons of each light is random, too.
    const double error = 5.0 * std::sqrt(1.5 / (share * paths));
    EXPECT_NEAR(totalOf(placed.table.flux, c) / power, 1.0, error);
    EXPECT_NEAR(totalOf(placed.table.firstBounceFlux, c) / power, 0.5, 0.5 * error);
  }
  EXPECT_EQ(totalOf(placed.table.flux, 1), 0.0);
  // The VPLs' shares of the surface add up to six unit squares. A hexagon of inradius r has 2
  // sqrt(3) r^2.
  double area = 0.0;
  for (const float r : placed.table.radius) area += 2.0 * std::sqrt(3.0) * double{r} * double{r};
  EXPECT_NEAR(area, 6.0, 0.3);
  EXPECT_NEAR(placed.table.areaEstimate, area, 1e-3);
}

TEST(PlaceLight, InstantRadiosityHasTheSameMean) {
  World world("cornell/scene.toml");
  world.scene.film = {32, 32};
  const double path = indirectByPaths(world, {{"spp", "512"}});
  double sum = 0.0;
  constexpr int kSets = 8;
  for (uint64_t seed = 1; seed <= kSets; ++seed) {
    const VplTable lit = placeVpls(world, with(fromLights(2000), {{"seed", typed(seed)}})).table;
    sum += indirectByVpls(world, lit, {{"clamp", "0.1"}, {"spp", "1"}}) / kSets;
  }
  EXPECT_NEAR(sum / path, 1.0, 0.04);
}

}  // namespace
}  // namespace bnvpl::test
