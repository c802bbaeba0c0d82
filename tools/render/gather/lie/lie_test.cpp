#include "core/errors.h"
#include "tests/support/gather_checks.h"
#include "tests/transport/plain_scene.h"

namespace bnvpl::test {
namespace {

FilmStats statsOf(const World& world, const VplTable& lit, const Given& options) {
  return renderVpls(world, lit,
                    with(with(kPlainRender, {{"gather", "lie"}, {"only", "indirect"}}), options))
      .stats;
}

// A few rays decide for many points, so that some light is lost and some too much.
TEST(Lie, HasTheEnergyOfAllVpls) {
  expectEnergyOfAll("lie", 0.02, 2);
  expectEnergyInFurnaceAndOfOneBounce("lie", 0.01);
}

TEST(Lie, WithoutClassesItIsTheSumOverAll) { expectSumOverAll("lie", {{"class-rays", "0"}}); }

// VPLs that few points of a cell face may face none that is drawn; the cells within it decide anew.
// The front of a board is less than a pixel high, and only its points face the red VPL. Cells are
// divided for the green one, which a leaf hides from some.
TEST(Lie, VplsThatFewPointsFaceAreNotLost) {
  Scene scene;
  addSquare(scene, {-2, 0, 0}, {4, 0, 0}, {0, 0, -4}, lambert(Vec3(0.7f)));
  addSquare(scene, {-2, -0.02f, 0}, {4, 0, 0}, {0, 0.02f, 0}, lambert(Vec3(0.7f)));
  addSquare(scene, {-0.3f, 0.7f, -0.7f}, {0.6f, 0, 0}, {0, 0, -0.6f}, lambert(Vec3(0.7f)));
  finishScene(scene);
  scene.camera.position = {0, 2.0f, 2.5f};
  scene.camera.forward = normalize(Vec3{0, -2.0f, -3.5f});
  scene.camera.up = cross(scene.camera.right, scene.camera.forward);
  scene.film = {96, 96};
  const World world(std::move(scene));
  VplTable lit;
  lit.position = lit.emitPosition = {{0.3f, -0.01f, 2.0f}, {0, 1.2f, -1.0f}};
  lit.normal = lit.emitNormal = {{0, 0, -1}, {0, -1, 0}};
  lit.flux = {{1, 0, 0}, {0, 1, 0}};
  lit.albedo = {Vec3(1.0f), Vec3(1.0f)};
  lit.firstBounceFlux = {Vec3{}, Vec3{}};
  lit.radius = {0.01f, 0.01f};
  const auto light = [&](const char* rays) {
    double red = 0.0;
    for (const char* seed : {"1", "2", "3", "4", "5", "6", "7", "8"}) {
      const Given options{{"gather", "lie"}, {"only", "indirect"}, {"class-rays", rays}};
      const Given all = with(with(kPlainRender, options), {{"seed", seed}});
      red += meanOfLayer(renderVpls(world, lit, all).image, "R");
    }
    return red;
  };
  EXPECT_NEAR(light("2") / light("0"), 1.0, 0.02);
}

TEST(Lie, VisibleAndHiddenVplsNeedNoRays) {
  for (const GatherCase* c : gatherCases()) {
    const FilmStats all = statsOf(c->world, c->lit, {{"class-rays", "0"}}),
                    ours = statsOf(c->world, c->lit, {});
    EXPECT_EQ(all.own[0] + all.own[1] + all.own[2], 0.0);
    EXPECT_LT(ours.shadowRays, 0.4 * all.shadowRays);
    EXPECT_GT(ours.own[0], 0.1 * all.shadowRays);
    EXPECT_LT(ours.own[0] + ours.shadowRays, all.shadowRays);
    EXPECT_GT(ours.own[1], 0.05 * all.cut);
    EXPECT_NEAR(ours.cut + ours.own[1], all.cut, 1e-6 * all.cut);
  }
}

TEST(Lie, MoreRaysAreNearerToAllVpls) {
  for (const GatherCase* c : gatherCases()) {
    const auto error = [&](const char* rays) {
      return relativeMseToAll(*c, "lie", {{"class-rays", rays}});
    };
    EXPECT_LT(error("8"), 0.5 * error("1"));
    EXPECT_LT(error("64"), 0.5 * error("8"));
  }
}

// Cells are smaller at each level, and more VPLs are visible from all of a cell or from none.
TEST(Lie, LevelsAreMadeWithinTheBoundOnRuns) {
  const GatherCase& c = *gatherCases().front();
  const auto rays = [&](const Given& options) {
    return statsOf(c.world, c.lit, options).shadowRays;
  };
  const double root = rays({{"cell-levels", "0"}}), one = rays({{"cell-levels", "1"}});
  EXPECT_NEAR(rays({{"cell-runs", "1"}}), root, 0.03 * root);
  EXPECT_LT(one, 0.8 * root);
  EXPECT_LT(rays({}), 0.8 * one);
}

TEST(Lie, PointsBeyondTheMemoryAreRefused) {
  World world("cornell/scene.toml");
  world.scene.film = {10'000'000, 10'000'000};
  try {
    statsOf(world, gatherCases().front()->lit, {});
    ADD_FAILURE();
  } catch (const MemoryError& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with("--gather lie needs")) << error.what();
  }
}

// A floor below a lit wall. Thin bars shade a few points of each cell.
Scene floorBelowBars() {
  Scene scene = floorAndWallBelowLamp({64, 48});
  for (int k = -4; k <= 4; ++k)
    addSquare(scene, {-2, 0.04f, 0.25f * float(k)}, {4, 0, 0}, {0, 0, -0.012f}, lambert(Vec3()));
  finishScene(scene);
  return scene;
}

// Light passes through an occluder that the rays of a cell miss.
TEST(Lie, ThinOccludersAreMissed) {
  const World world{floorBelowBars()};
  const VplTable lit = litVpls(world, {{"count", "300"}}, {{"photons", "50k"}}, {{"count", "3k"}});
  const auto light = [&](const char* rays) {
    return statsOf(world, lit, {{"class-rays", rays}, {"spp", "2"}}).indirect;
  };
  const double all = light("0"), few = light("16") / all - 1.0, many = light("1024") / all - 1.0;
  EXPECT_GT(few, 0.005);
  EXPECT_LT(std::fabs(many), 0.2 * few);
}

}  // namespace
}  // namespace bnvpl::test
