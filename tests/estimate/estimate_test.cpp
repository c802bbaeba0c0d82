#include "tools/estimate/estimate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "tests/support/pipeline.h"
#include "tests/support/threads.h"
#include "tests/transport/plain_scene.h"

namespace bnvpl::test {
namespace {

TEST(Estimate, EnergyAccountCloses) {
  const World world("u-shape/scene.toml");
  for (const char* emission : {"power", "guided"}) {
    const EstimateResult result =
        lightVpls(world, keptVpls(world, {{"count", "1000"}}, {{"count", "10k"}}),
                  {{"method", "guarded"}, {"photons", "100k"}, {"emission", emission}});
    const EnergyAccount& a = result.energy;
    // Power is divided exactly, and estimated by guided photons.
    const double close = emission == std::string_view("power") ? 1e-4 : 2e-3;
    EXPECT_NEAR(a.emitted, double{mean(world.lights.totalPower())}, close * a.emitted);
    EXPECT_NEAR(a.escaped + a.absorbed, a.emitted, 1e-4 * a.emitted);
    EXPECT_NEAR(a.deposited + a.outside + a.incompatible + a.hidden, a.reflected,
                1e-6 * a.reflected);
    EXPECT_NEAR(totalFlux(result.table), a.deposited, 1e-5 * a.deposited);
    EXPECT_GT(a.deposited, 0.0);
  }
}

TEST(Estimate, AnyThreadCountGivesTheSameBits) {
  const World world("cornell/scene.toml");
  const VplTable start = keptVpls(world, {{"count", "1000"}}, {{"count", "10k"}});
  VplTable first;
  for (const size_t threads : {1, 2, 7}) {
    const VplTable lit = withThreads(threads, [&] {
      return lightVpls(world, start, {{"photons", "50k"}}).table;
    });
    if (threads == 1) first = lit;
    EXPECT_EQ(lit.flux, first.flux);
    EXPECT_EQ(lit.photons, first.photons);
    EXPECT_EQ(lit.relativeError, first.relativeError);
  }
}

// Over independent seeds, a VPL's flux scatters about as much as its stated error.
TEST(Estimate, StatedErrorMatchesTheSpreadOverSeeds) {
  const World world("cornell/scene.toml");
  const VplTable start = keptVpls(world, {{"count", "50"}}, {{"count", "4000"}});
  constexpr int kSeeds = 24;
  std::vector<double> sum(50), sum2(50), stated(50);
  for (uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const VplTable lit = lightVpls(world, start, {{"photons", "20k"}, {"seed", typed(seed)}}).table;
    for (size_t i = 0; i < 50; ++i) {
      const double f = double{mean(lit.flux[i])};
      sum[i] += f;
      sum2[i] += f * f;
      stated[i] += double{lit.relativeError[i]} / kSeeds;
    }
  }
  double ratio = 0.0;
  for (size_t i = 0; i < 50; ++i) {
    const double m = sum[i] / kSeeds;
    ratio += std::sqrt(std::max(0.0, sum2[i] / kSeeds - m * m)) / m / stated[i] / 50.0;
  }
  EXPECT_NEAR(ratio, 1.0, 0.2);
}

// VPLs emit from points on their own surface, and their positions stay.
TEST(Estimate, EmissionPointsLieOnTheVplsSurface) {
  const World world("furnace/scene.toml");
  const VplTable start = keptVpls(world, {{"count", "300"}}, {{"count", "6000"}});
  const Given photons{{"photons", "100k"}, {"emit-points", "4"}};
  const VplTable still = lightVpls(world, start, with(photons, {{"emit-points", "0"}})).table;
  const VplTable lit = lightVpls(world, start, photons).table;
  EXPECT_EQ(still.emitPosition, start.position);
  EXPECT_EQ(lit.position, start.position);
  EXPECT_EQ(lit.normal, start.normal);
  ASSERT_EQ(lit.emitPoints, 4u);
  size_t apart = 0;
  for (size_t k = 0; k < lit.emitPosition.size(); ++k) {
    const size_t i = k / 4;
    EXPECT_EQ(lit.emitNormal[k], start.normal[i]);
    EXPECT_NEAR(dot(lit.emitPosition[k] - start.position[i], start.normal[i]), 0.0f, 1e-5f);
    EXPECT_LT(length(lit.emitPosition[k] - start.position[i]), 1.7f * start.radius[i]);
    apart += lit.emitPosition[k] != lit.emitPosition[4 * i];
  }
  EXPECT_GT(apart, 850u);  // 900 points in all
  EXPECT_EQ(totalFlux(lit), totalFlux(still));
}

// A VPL stands in the middle of a floor's edge under a sun in the zenith. It represents the half
// disk of radius R, its reach, whose centroid lies 4 R / (3 pi) from the edge. Its emission points
// are spread uniformly over that half disk.
TEST(Estimate, OneVplAtTheRimOfASunnyFloor) {
  Scene scene;
  addSquare(scene, {0, 0, 2}, {4, 0, 0}, {0, 0, -4}, lambert(Vec3(0.5f)));
  addSquare(scene, {3.9f, 1, -2}, {0.01f, 0, 0}, {0, 0, 0.01f}, lambert(Vec3(0.0f)));  // a height
  finishScene(scene);
  LightSpec sun;
  sun.type = LightType::Directional;
  sun.direction = {0, -1, 0};
  sun.emission = {6, 4, 2};  // W/m2
  scene.lights.push_back(sun);
  const World world(std::move(scene));
  VplTable vpls;
  vpls.stage = VplStage::Eliminated;
  vpls.position = {{1e-4f, 0, 0}};
  vpls.normal = {{0, 1, 0}};
  vpls.albedo = {Vec3(0.5f)};
  vpls.id = {1};
  vpls.radius = {0.25f};
  const VplTable lit = lightVpls(world, vpls,
                                 {{"method", "guarded"},
                                  {"photons", "400k"},
                                  {"emission", "power"},
                                  {"radius", "2"},
                                  {"emit-points", "64"}})
                           .table;

  const double reach = 0.5, area = 0.5 * double{kPi} * reach * reach;
  const auto photons = double(lit.photons[0]);
  EXPECT_NEAR(photons, 400000 * area / 16.0, 5.0 * std::sqrt(400000 * area / 16.0));
  EXPECT_NEAR(lit.relativeError[0] * std::sqrt(photons), 1.0, 1e-3);  // equal deposits
  for (size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(double{lit.flux[0][c]}, 0.5 * double{world.scene.lights[0].emission[c]} * area,
                5.0 / std::sqrt(photons) * double{lit.flux[0][c]});
  }
  EXPECT_EQ(lit.firstBounceFlux[0], lit.flux[0]);
  const double centroid = 4.0 * reach / (3.0 * double{kPi}),
               spread = std::sqrt(reach * reach / 4.0 - centroid * centroid);
  ASSERT_EQ(lit.emitPosition.size(), 64u);
  Vec3 moved;
  for (const Vec3 p : lit.emitPosition) moved += (p - lit.position[0]) / 64.0f;
  EXPECT_NEAR(double{moved.x}, centroid, 4.0 * spread / 8.0);
  EXPECT_NEAR(double{moved.y}, 0.0, 1e-6);
  EXPECT_NEAR(double{moved.z}, 0.0, 4.0 * 0.5 * reach / 8.0);
}

}  // namespace
}  // namespace bnvpl::test
