// Local virtual lights: their limits, what they count, and where they fail.
#include <array>
#include <numeric>

#include "tests/support/gather_checks.h"
#include "tests/transport/plain_scene.h"

namespace bnvpl::test {
namespace {

const Given kLocal{{"compensate", "local"}};
// Receivers that shoot for themselves, and hits that are points: no bias is left.
const Given kExactLocal =
    with(kLocal, {{"local-block", "1"}, {"local-rays", "8"}, {"local-radius", "0"}});

FilmStats statsOf(const World& world, const VplTable& lit, const Given& options) {
  const Given indirect = with(kPlainRender, {{"only", "indirect"}, {"reuse", "1"}});
  return renderVpls(world, lit, with(indirect, options)).stats;
}

// Light that compensation adds, of one seed and the mean over the first ones.
double restored(const World& world, const VplTable& lit, const Given& options, uint64_t seed) {
  return statsOf(world, lit, with(options, {{"seed", typed(seed)}})).compensated;
}
double meanRestored(const World& world, const VplTable& lit, const Given& options) {
  constexpr uint64_t kSeeds = 4;
  double sum = 0.0;
  for (uint64_t seed = 1; seed <= kSeeds; ++seed) sum += restored(world, lit, options, seed);
  return sum / kSeeds;
}

VplTable vplsFromLights(const World& world, const char* count = "200") {
  return placeVpls(world, {{"method", "light"}, {"count", count}}).table;
}

struct SmallBox : World {
  SmallBox() : World("cornell/scene.toml") { scene.film = {24, 24}; }
};

TEST(Local, WithBlocksOfOneHasTheMeanOfKolligKeller) {
  const SmallBox world;
  const VplTable lit = vplsFromLights(world);
  for (const char* light : {"point", "disk"}) {
    const Given both{{"light", light}, {"clamp", "1"}, {"gather", "stochastic"}, {"spp", "16"}};
    const Given byPaths = with(both, {{"compensate", "kollig-keller"}}),
                ours = with(both, kExactLocal);
    const double scale = meanRestored(world, lit, byPaths);
    EXPECT_GT(scale, 0.0);
    const auto errorOf = [&](uint64_t seed) {
      return (restored(world, lit, ours, seed) - restored(world, lit, byPaths, seed)) / scale;
    };
    EXPECT_TRUE(hasMeanZero(errorOf, 12, 0.03)) << light;
  }
}

// Points in blocks keep the light but for shadows; spheres lose some, more with fewer rays.
TEST(Local, BlocksOfManyRaysKeepTheLight) {
  const SmallBox world;
  const VplTable lit = vplsFromLights(world);
  const auto light = [&](const Given& options) {
    const Given many{{"clamp", "1"}, {"spp", "64"}, {"gather", "stochastic"}, {"control", "none"}};
    return meanRestored(world, lit, with(many, options));
  };
  const double exact = light(kExactLocal);
  EXPECT_NEAR(light(with(kLocal, {{"local-radius", "0"}})) / exact, 1.0, 0.04);
  EXPECT_NEAR(light(kLocal) / exact, 0.98, 0.04);
  const double few = light(with(kLocal, {{"local-shooters", "8"}}));
  EXPECT_LT(few, 0.85 * exact);
  EXPECT_GT(few, 0.6 * exact);
}

TEST(Local, AddsNothingWithoutABound) {
  const SmallBox world;
  const VplTable lit = vplsFromLights(world);
  const FilmStats stats = statsOf(world, lit, with(kLocal, {{"clamp", "0"}}));
  EXPECT_EQ(stats.compensated, 0.0);
  EXPECT_EQ(stats.own[0], 0.0);
}

TEST(Local, CountsTheLightsOfABlockAndWhatTheyRestore) {
  const SmallBox world;
  const VplTable lit = vplsFromLights(world);
  const Given options = with(kLocal, {{"only", "indirect"}, {"clamp", "2"}});
  const auto lights = [&](const Given& more) {
    return statsOf(world, lit, with(options, more)).own[0];
  };
  EXPECT_GT(lights({}), 1.0);
  EXPECT_LE(lights({}), 64.0);  // each receiver sends one ray
  EXPECT_NEAR(lights({{"local-rays", "2"}}) / lights({}), 2.0, 0.2);
  // The counter follows those of the gather.
  const RenderResult result =
      renderVpls(world, lit,
                 with(with(kPlainRender, options),
                      {{"gather", "shirley"}, {"layers", "brightlights,locallights"}}));
  EXPECT_NEAR(meanOfLayer(result.image, "locallights") / result.stats.own[1], 1.0, 1e-4);
  EXPECT_NEAR(meanOfLayer(result.image, "brightlights") / result.stats.own[0], 1.0, 1e-4);
  EXPECT_NEAR(result.stats.own[1] / lights({}), 1.0, 0.2);
}

// In the furnace every surface has the same light; the other scene has one bounce between two
// patches. The tolerance to paths is the noise of the VPLs, which are the same for all.
TEST(Local, KeepsTheEnergy) {
  for (const char* name : {"furnace/scene.toml", "test/one-bounce.toml"}) {
    World world(name);
    world.scene.film = {32, 24};
    const double paths = indirectByPaths(world, {{"spp", "256"}});
    const VplTable lit = vplsFromLights(world, "1000");
    const auto light = [&](const Given& options) {
      const Given many{{"clamp", "2"}, {"spp", "64"}, {"gather", "stochastic"}};
      return statsOf(world, lit, with(many, options)).indirect / paths;
    };
    const double ours = light(kLocal), exact = light(kExactLocal);
    EXPECT_LT(light({}), ours - 0.003) << name;
    EXPECT_NEAR(ours, exact, 0.01) << name;
    EXPECT_NEAR(exact, 1.0, 0.1) << name;
  }
}

// A wall without thickness stands on a floor. A lamp between it and a block lights its right side;
// no light reaches the floor on its left. The camera looks down on both sides.
Scene floorWithThinWall() {
  Scene scene;
  const Material white = lambert(Vec3(0.8f));
  addSquare(scene, {-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, white);        // floor
  addSquare(scene, {0, -0.1f, 2}, {0, 0, -4}, {0, 0.5f, 0}, white);  // wall
  addSquare(scene, {0.4f, 0, -2}, {0, 0, 4}, {0, 0.3f, 0}, white);   // block
  finishScene(scene);
  LightSpec light;
  light.position = {0.2f, 0.15f, 0.0f};
  light.emission = Vec3(1.0f);
  scene.lights = {light};
  scene.film = {48, 48};
  scene.camera.position = {0.1f, 3.0f, 0.0f};
  scene.camera.forward = {0, -1, 0};
  scene.camera.right = {1, 0, 0};
  scene.camera.up = cross(scene.camera.right, scene.camera.forward);
  scene.camera.verticalFovRad = 0.65f;
  return scene;
}

// It must fail where a thin wall stands in a block: without shadow rays, local lights shine
// through.
TEST(Local, LeaksThroughAThinWallWithinABlock) {
  const World world{floorWithThinWall()};
  const VplTable lit = vplsFromLights(world, "2000");
  const auto darkSide = [&](const Given& options) {  // by column, left of the wall
    const Image image =
        renderVpls(
            world, lit,
            with(with(kPlainRender,
                      {{"only", "indirect"}, {"control", "none"}, {"clamp", "20"}, {"spp", "1"}}),
                 options))
            .image;
    std::array<double, 20> columns{};
    for (size_t i = 0; i < image.pixelCount(); ++i)
      if (i % 48 < columns.size()) columns[i % 48] += double{(*image.find("G"))[i]};
    return columns;
  };
  const auto sum = [](std::span<const double> columns) {
    return std::accumulate(columns.begin(), columns.end(), 0.0);
  };
  EXPECT_EQ(sum(darkSide({{"compensate", "near-field"}})), 0.0);
  EXPECT_EQ(sum(darkSide(kExactLocal)), 0.0);
  const std::array<double, 20> leak = darkSide(kLocal);
  EXPECT_EQ(sum(std::span(leak).first(16)), 0.0);  // blocks that end before the wall
  EXPECT_GT(sum(std::span(leak).last(4)), 0.0);
}

TEST(Local, IsRefusedWhereNeighboursMustNotShareNoise) {
  EXPECT_THROW(resolveRender(with(kLocal, {{"for-denoiser", "on"}})), UsageError);
}

}  // namespace
}  // namespace bnvpl::test
