// The light tracer against known results, and against the path tracer, its adjoint.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/pipeline.h"
#include "tests/support/z_test.h"

namespace bnvpl::test {
namespace {

constexpr unsigned kBlock = 8;  // pixels

// Means of the indirect light over blocks of pixels, all channels together.
std::vector<double> blockMeans(const Image& image) {
  const int across = image.width / int(kBlock), down = image.height / int(kBlock);
  std::vector<double> means(size_t(across * down));
  for (const char* channel : {"indirect.R", "indirect.G", "indirect.B"}) {
    const std::vector<float>& data = *image.find(channel);
    for (int y = 0; y < down * int(kBlock); ++y) {
      for (int x = 0; x < across * int(kBlock); ++x) {
        means[size_t(y / int(kBlock) * across + x / int(kBlock))] +=
            double{data[size_t(y * image.width + x)]} / (3.0 * kBlock * kBlock);
      }
    }
  }
  return means;
}

void expectTheSameImage(const World& world, unsigned maxBounces, double perBlock, double perImage) {
  const Given options{{"layers", "indirect"}, {"max-bounces", typed(maxBounces)}};
  const RenderResult path = renderWithout(world, "path", with(options, {{"spp", "512"}}));
  const RenderResult light = renderWithout(world, "light", with(options, {{"spp", "64"}}));
  EXPECT_NEAR(light.stats.indirect / path.stats.indirect, 1.0, perImage);
  EXPECT_EQ(light.stats.nonFinite, 0u);
  const std::vector<double> a = blockMeans(path.image), b = blockMeans(light.image);
  for (size_t i = 0; i < a.size(); ++i) {
    EXPECT_NEAR(b[i], a[i], perBlock * a[i] + 0.01 * path.stats.indirect) << "block " << i;
  }
}

TEST(LightTracer, FurnaceIsTheGeometricSeries) {
  const World world("furnace/scene.toml");  // Le = 1, rho = 0.5
  const auto indirect = [&](const char* bounces) {
    return renderWithout(world, "light", {{"spp", "32"}, {"max-bounces", bounces}}).stats.indirect;
  };
  EXPECT_NEAR(indirect("64"), 0.5, 0.005);   // rho^2 / (1 - rho)
  EXPECT_NEAR(indirect("1"), 0.25, 0.0025);  // one bounce alone
}

TEST(LightTracer, AgreesWithThePathTracerBlockByBlock) {
  World world("cornell/scene.toml");
  world.scene.film = {32, 32};
  for (const unsigned bounces : {1u, 32u}) expectTheSameImage(world, bounces, 0.06, 0.01);
}

TEST(LightTracer, AgreesInAFilmThatIsNotSquareWithSeveralLights) {
  Scene scene = loadScene(fs::path(BNVPL_SCENES_DIR) / "cornell/scene.toml");
  scene.film = {48, 24};
  scene.lights.assign(2, LightSpec{});
  scene.lights[0].type = LightType::Environment;
  scene.lights[0].emission = Vec3{2.0f};
  scene.lights[1].position = {0.3f, 0.45f, 0.1f};
  scene.lights[1].emission = Vec3{0.1f};
  expectTheSameImage(World(std::move(scene)), 32, 0.06, 0.01);
}

TEST(LightTracer, DirectLightIsThePathTracers) {
  World world("cornell/scene.toml");
  world.scene.film = {32, 32};
  const Given options{{"spp", "4"}, {"layers", "direct,indirect"}};
  const Image paths = renderWithout(world, "path", options).image,
              photons = renderWithout(world, "light", options).image;
  EXPECT_EQ(*paths.find("direct.G"), *photons.find("direct.G"));
  EXPECT_NE(*paths.find("indirect.G"), *photons.find("indirect.G"));
}

// The run is stopped after every round and continued from the saved bytes.
TEST(LightTracer, ContinuesFromEveryRound) {
  World world("cornell/scene.toml");
  world.scene.film = {40, 40};
  const Given options{{"spp", "8"}};  // 12800 photons
  const RenderResult whole = renderWithout(world, "light", options);
  struct Stopped {};
  WorkControls controls;
  controls.pause = [] { return true; };
  controls.save = [&](const std::string& state) {
    controls.state = state;
    throw Stopped{};
  };
  int stops = 0;
  for (bool ended = false; !ended;) {
    try {
      const WorkControls begin = controls;
      const RenderResult pieces = renderWithout(world, "light", options, begin);
      EXPECT_EQ(*pieces.image.find("R"), *whole.image.find("R"));
      EXPECT_EQ(pieces.stats.indirect, whole.stats.indirect);
      ended = true;
    } catch (const Stopped&) {
      ++stops;
    }
  }
  EXPECT_GT(stops, 3);  // more than the rounds of samples
}

// All walls of a box have shading normals far from the geometric ones, where the BSDF differs from
// its adjoint (Veach 1997, section 5.3).
TEST(LightTracer, AgreesOnShadingNormals) {
  Scene scene = loadScene(fs::path(BNVPL_SCENES_DIR) / "cornell/scene.toml");
  scene.film = {32, 32};
  for (Triangle& t : scene.triangles) {
    const Vec3 a = scene.positions[t.position[0]], b = scene.positions[t.position[1]],
               c = scene.positions[t.position[2]];
    t.normal.fill(static_cast<uint32_t>(scene.normals.size()));
    scene.normals.push_back(normalize(normalize(cross(b - a, c - a)) + Vec3{0.35f, 0.25f, -0.3f}));
  }
  expectTheSameImage(World(std::move(scene)), 8, 0.06, 0.01);
}

// Light comes round a corner, which few paths find; its photons branch behind the corner.
TEST(LightTracer, HasLessNoiseWhereLightComesRoundACorner) {
  World world("u-shape/scene.toml");
  world.scene.film = {32, 24};
  double path = 0.0, light = 0.0;  // sums of indirect light
  const auto noise = [&](const char* integrator, const char* spp, double& indirect) {
    const Render render = [&](uint64_t seed) {
      const RenderResult result = renderWithout(
          world, integrator, {{"spp", spp}, {"seed", typed(seed)}, {"only", "indirect"}});
      indirect += result.stats.indirect;
      return result.image;
    };
    return noiseOf(render, 4);
  };
  const double byPaths = noise("path", "256", path), byPhotons = noise("light", "128", light);
  EXPECT_LT(byPhotons, 0.5 * byPaths);
  EXPECT_NEAR(light / path, 1.0, 0.05);
}

// Surfaces seen over mirrors, light that arrives via mirrors, and gloss lit by photons.
TEST(LightTracer, AgreesWithMirrorsAndGloss) {
  Scene scene = loadScene(fs::path(BNVPL_SCENES_DIR) / "cornell/scene.toml");
  scene.film = {32, 32};
  Material& tall = scene.materials.at(scene.triangles.back().material);
  tall.phong().diffuse = Vec3{0.2f};
  tall.phong().mirror = Vec3{0.7f};
  Material& wall = scene.materials.at(scene.triangles.front().material);
  wall.phong().diffuse = Vec3{0.3f};
  wall.phong().glossy = Vec3{0.5f};
  wall.phong().exponent = 12.0f;
  expectTheSameImage(World(std::move(scene)), 16, 0.08, 0.015);
}

TEST(LightTracer, ClosedRoomsStayDark) {
  const World world("test/two-rooms.toml");
  EXPECT_EQ(renderWithout(world, "light", {{"spp", "64"}}).stats.indirect, 0.0);
}

}  // namespace
}  // namespace bnvpl::test
