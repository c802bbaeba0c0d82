#include <gtest/gtest.h>

#include "tests/support/pipeline.h"

namespace bnvpl::test {
namespace {

TEST(PathTracer, FurnaceIsExact) {
  const World world("furnace/scene.toml");
  FilmStats stats;
  const Image image = renderPaths(world, {.spp = 64}, stats, 64);
  EXPECT_NEAR(meanOf(image), 2.0, 0.01);  // Le / (1 - rho)
}

TEST(PathTracer, TruncatedFurnaceIsThePartialSeries) {
  const World world("furnace/scene.toml");
  FilmStats stats;
  const Image image = renderPaths(world, {.spp = 64}, stats, 1);
  EXPECT_NEAR(meanOf(image), 1.0 + 0.5 + 0.25, 0.01);  // emitted, direct, one bounce
}

// Radiance of a diffuse patch under a parallel emitting one, by the form factor of two aligned
// parallel squares (Howell's catalogue, C-11): W = side / distance = 0.2 gives F = 0.012404.
TEST(PathTracer, TwoPatchFormFactor) {
  const World world("test/two-patches.toml");
  const Material* receiver = nullptr;
  const Material* emitter = nullptr;
  for (const Material& m : world.scene.materials) (isBlack(m.emission) ? receiver : emitter) = &m;
  FilmStats stats;
  FilmOptions film{.spp = 64, .layers = kLayerAlbedo};
  const Image image = renderPaths(world, film, stats, 0);
  // Mean over the pixels that the receiver covers wholly; its irradiance varies by less than 2 %.
  const std::vector<float>&r = *image.find("R"), &albedo = *image.find("albedo.R");
  double sum = 0.0;
  size_t covered = 0;
  for (size_t i = 0; i < r.size(); ++i) {
    if (albedo[i] < 0.999f * receiver->diffuse.x) continue;
    sum += double{r[i]};
    ++covered;
  }
  ASSERT_GT(covered, 100u);
  const double expected = double{emitter->emission.x} * double{receiver->diffuse.x} * 0.012404;
  EXPECT_NEAR(sum / double(covered), expected, 0.02 * expected);
}

TEST(PathTracer, SplitsDirectAndIndirectWithoutRest) {
  World world("cornell/scene.toml");
  world.scene.film = {32, 32};
  FilmStats all, direct, indirect;
  renderPaths(world, {.spp = 256}, all);
  renderPaths(world, {.spp = 256, .only = Only::Direct}, direct);
  renderPaths(world, {.spp = 256, .only = Only::Indirect}, indirect);
  EXPECT_NEAR(direct.direct, all.direct, 0.02 * all.direct);
  EXPECT_NEAR(indirect.indirect, all.indirect, 0.02 * all.indirect);
}

// The VPL renderer's direct light is the path tracer's, by another estimator.
TEST(PathTracer, DirectLightAgreesWithLightSampling) {
  World world("cornell/scene.toml");
  world.scene.film = {32, 32};
  FilmStats path, light;
  renderPaths(world, {.spp = 256, .only = Only::Direct}, path);
  VplSettings s;
  s.film = {.spp = 256, .only = Only::Direct};
  renderVpls(world, VplTable{}, s, light);
  EXPECT_NEAR(light.direct / path.direct, 1.0, 0.01);
}

}  // namespace
}  // namespace bnvpl::test
