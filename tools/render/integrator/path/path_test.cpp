#include <gtest/gtest.h>

#include "tests/support/pipeline.h"

namespace bnvpl::test {
namespace {

TEST(PathTracer, FurnaceIsExact) {
  const World world("furnace/scene.toml");
  const Image image = renderWithout(world, "path", {{"spp", "64"}, {"max-bounces", "64"}}).image;
  EXPECT_NEAR(meanOf(image), 2.0, 0.01);  // Le / (1 - rho)
}

TEST(PathTracer, TruncatedFurnaceIsThePartialSeries) {
  const World world("furnace/scene.toml");
  const Image image = renderWithout(world, "path", {{"spp", "64"}, {"max-bounces", "1"}}).image;
  EXPECT_NEAR(meanOf(image), 1.0 + 0.5 + 0.25, 0.01);  // emitted, direct, one bounce
}

// Radiance of a diffuse patch under a parallel emitting one, from the form factor of two aligned
// parallel squares (Howell's catalogue, C-11): W = side / distance = 0.2 gives F = 0.012404.
TEST(PathTracer, TwoPatchFormFactor) {
  const World world("test/two-patches.toml");
  const Material* receiver = nullptr;
  const Material* emitter = nullptr;
  for (const Material& m : world.scene.materials) (isBlack(m.emission) ? receiver : emitter) = &m;
  const Given options{{"spp", "64"}, {"layers", "albedo"}, {"max-bounces", "0"}};
  const Image image = renderWithout(world, "path", options).image;
  // Mean over the pixels inside the receiver; its irradiance varies by less than 2 %.
  const std::vector<float>&r = *image.find("R"), &albedo = *image.find("albedo.R");
  double sum = 0.0;
  size_t covered = 0;
  for (size_t i = 0; i < r.size(); ++i) {
    if (albedo[i] < 0.999f * receiver->phong().diffuse.x) continue;
    sum += double{r[i]};
    ++covered;
  }
  ASSERT_GT(covered, 100u);
  const double expected =
      double{emitter->emission.x} * double{receiver->phong().diffuse.x} * 0.012404;
  EXPECT_NEAR(sum / double(covered), expected, 0.02 * expected);
}

TEST(PathTracer, SplitsDirectAndIndirectWithoutRest) {
  World world("cornell/scene.toml");
  world.scene.film = {32, 32};
  const auto stats = [&](const char* only) {
    return renderWithout(world, "path", {{"spp", "256"}, {"only", only}}).stats;
  };
  const FilmStats all = stats("all"), direct = stats("direct"), indirect = stats("indirect");
  EXPECT_NEAR(direct.direct, all.direct, 0.02 * all.direct);
  EXPECT_NEAR(indirect.indirect, all.indirect, 0.02 * all.indirect);
}

// The Cornell box in daylight: area light, sky through the open front, low sun and point light.
Scene boxInDaylight() {
  Scene scene = loadScene(fs::path(BNVPL_SCENES_DIR) / "cornell/scene.toml");
  scene.film = {32, 32};
  scene.lights.assign(3, LightSpec{});
  LightSpec &sky = scene.lights[0], &sun = scene.lights[1], &bulb = scene.lights[2];
  sky.type = LightType::Environment;
  sky.emission = Vec3{2.0f};
  sun.type = LightType::Directional;
  sun.direction = normalize(Vec3{0.2f, -0.3f, 1.0f});
  sun.emission = Vec3{3.0f};
  sun.angularRadiusRad = 0.02f;
  bulb.position = {0.3f, 0.45f, 0.1f};
  bulb.emission = Vec3{0.1f};
  return scene;
}

// The VPL renderer estimates the same direct light by other means: by light sampling alone, and
// together with the compensating rays, without counting any light twice.
TEST(PathTracer, DirectLightAgreesWithTheVplRenderers) {
  for (const bool daylight : {false, true}) {
    World world = daylight ? World(boxInDaylight()) : World("cornell/scene.toml");
    world.scene.film = {32, 32};
    const Given film{{"spp", "512"}, {"only", "direct"}};
    const FilmStats path = renderWithout(world, "path", film).stats;
    const Given plain = with(with(kPlainDirect, film), {{"spp", "128"}});
    const FilmStats light = renderVpls(world, {}, plain).stats;
    EXPECT_NEAR(light.direct / path.direct, 1.0, 0.01) << daylight;
    const Given nearField = with(plain, {{"compensate", "near-field"}, {"near-field-rays", "4"}});
    const FilmStats both = renderVpls(world, {}, nearField).stats;
    EXPECT_NEAR(both.direct / light.direct, 1.0, 0.01) << daylight;
  }
}

}  // namespace
}  // namespace bnvpl::test
