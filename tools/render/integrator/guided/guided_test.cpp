// The guided path tracer against the path tracer, whose image it must have whatever the VPLs are,
// and guarantees of its guide.
#include <gtest/gtest.h>

#include <cmath>

#include "scene/builder/scene_builder.h"
#include "tests/render/lit_rooms.h"
#include "tests/support/pipeline.h"
#include "tests/support/threads.h"
#include "tests/support/z_test.h"
#include "tools/render/integrator/guided/guide.h"

namespace bnvpl::test {
namespace {

VplTable fewLit(const World& world) {
  return litVpls(world, {{"count", "60"}}, {{"photons", "20k"}}, {{"count", "1200"}});
}

Render paths(const World& world, const Given& options) {
  return [&world, options](uint64_t seed) {
    return renderWithout(world, "path", with(options, {{"seed", typed(seed)}})).image;
  };
}
Render guided(const World& world, const VplTable& lit, const Given& options) {
  return [&world, &lit, options](uint64_t seed) {
    return renderVpls(world, lit,
                      with(options, {{"integrator", "guided"}, {"seed", typed(seed + 1000)}}))
        .image;
  };
}

World cornell(uint32_t side) {
  Scene scene = loadScene(fs::path(BNVPL_SCENES_DIR) / "cornell/scene.toml");
  scene.film = {side, side};
  return World(std::move(scene));
}

TEST(DirectionGrid, FindsTheCellThatADirectionWasDrawnIn) {
  const DirectionGrid grid{7};
  Rng rng(3, 0);
  for (uint32_t k = 0; k < 70; ++k) {
    for (uint32_t cell = 0; cell < grid.cells(); ++cell) {
      const float u = 0.01f + 0.98f * rng.next(), v = 0.01f + 0.98f * rng.next();
      ASSERT_EQ(grid.cellOf(grid.direction(cell, u, v)), cell) << u << " " << v;
    }
  }
}

// The density over the sphere is that of the draws: it integrates to 1, and its integral over half
// of the sphere is the share of draws there.
TEST(Guide, DensitiesAreThoseOfTheDraws) {
  const World world("u-shape/scene.toml");
  const VplTable lit = fewLit(world);
  const Guide guide(lit, world.accel, world.lights, 1, 64, {});
  size_t known = 0;
  for (uint32_t region = 0; region < lit.size(); region += 7) {
    if (!guide.knows(region)) continue;
    ++known;
    Rng rng(5, region);
    double integral = 0.0, half = 0.0, halfOfDraws = 0.0;
    int rounded = 0;
    const Vec3 side = normalize(Vec3{1.0f, 0.3f, 0.2f});
    constexpr int kDraws = 20000;
    for (int k = 0; k < kDraws; ++k) {
      const float u = rng.next(), v = rng.next();
      const Vec3 w = sampleSphere(u, v);
      const double pdf = double{guide.pdf(region, w)} * 4.0 * double{kPi} / kDraws;
      integral += pdf;
      half += dot(w, side) > 0.0f ? pdf : 0.0;
      float drawn = 0.0f;
      const Vec3 d = guide.sample(region, {rng.next(), rng.next()}, drawn);
      halfOfDraws += dot(d, side) > 0.0f ? 1.0 / kDraws : 0.0;
      rounded += std::fabs(guide.pdf(region, d) - drawn) > 1e-3f * drawn;  // in the next cell
    }
    EXPECT_LT(rounded, kDraws / 1000) << region;
    EXPECT_NEAR(integral, 1.0, 0.15) << region;
    EXPECT_NEAR(half, halfOfDraws, 0.15) << region;
  }
  EXPECT_GT(known, 4u);
}

TEST(Guided, FurnaceIsExact) {
  const World world("furnace/scene.toml");
  const VplTable lit = fewLit(world);
  const Image image =
      renderVpls(world, lit,
                 {{"integrator", "guided"}, {"spp", "16"}, {"paths", "4"}, {"max-bounces", "64"}})
          .image;
  EXPECT_NEAR(meanOf(image), 2.0, 0.01);  // Le / (1 - rho)
}

// A budget has no number of samples, to which photons for light over mirrors could be fitted.
TEST(Guided, EndsByPasses) {
  Scene scene = loadScene(fs::path(BNVPL_SCENES_DIR) / "cornell/scene.toml");
  scene.film = {8, 8};
  scene.materials[0].phong().mirror = Vec3(0.5f);
  const World world(std::move(scene));
  const VplTable lit = fewLit(world);
  const FilmStats stats = renderVpls(world, lit, {{"integrator", "guided"}, {"passes", "2"}}).stats;
  EXPECT_GT(stats.indirect, 0.0);
}

TEST(Guided, ClosedRoomsStayDark) {
  const World world("test/two-rooms.toml");
  const VplTable lit = fewLit(world);
  const FilmStats stats = renderVpls(world, lit, {{"integrator", "guided"}, {"spp", "16"}}).stats;
  EXPECT_EQ(stats.direct + stats.indirect, 0.0);
}

// The area light, a sky through the open front, a sun and a point light, with a mirror and gloss.
TEST(Guided, HasThePathTracersImage) {
  Scene scene = loadScene(fs::path(BNVPL_SCENES_DIR) / "cornell/scene.toml");
  scene.film = {12, 12};
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
  Material& tall = scene.materials.at(scene.triangles.back().material);
  tall.phong().diffuse = Vec3{0.2f};
  tall.phong().mirror = Vec3{0.7f};
  Material& wall = scene.materials.at(scene.triangles.front().material);
  wall.phong().diffuse = Vec3{0.3f};
  wall.phong().glossy = Vec3{0.5f};
  wall.phong().exponent = 12.0f;
  // Only photons find the point light over a mirror; the path tracer has none.
  Scene withoutMirror = scene;
  withoutMirror.materials.at(scene.triangles.back().material).phong().mirror = Vec3{};
  scene.lights.pop_back();
  for (Scene& of : {std::ref(scene), std::ref(withoutMirror)}) {
    const World world(std::move(of));
    const VplTable lit = fewLit(world);
    // Direct light has far more noise by the path tracer, whose samples cost less.
    const Given few{{"spp", "8"}}, many{{"spp", "144"}};
    EXPECT_TRUE(sameExpectation(paths(world, many), guided(world, lit, few)));
    const Given direct{{"only", "direct"}}, indirect{{"only", "indirect"}};
    const Render byPaths = remembered(paths(world, with(many, direct)));
    for (const Given& samples : {Given{}, Given{{"direct-samples", "1"}}}) {
      EXPECT_TRUE(sameExpectation(byPaths, guided(world, lit, with(with(few, direct), samples))))
          << samples.size();
    }
    EXPECT_TRUE(sameExpectation(paths(world, with(indirect, {{"spp", "64"}})),
                                guided(world, lit, with(indirect, {{"spp", "16"}}))));
  }
}

// A closed room with a point light in a box of glass, which the camera does not see, and a wall
// that is half a mirror.
Scene bulbInGlass() {
  SceneBuilder builder("bulb in glass");
  builder.setFilm({10, 10});
  Camera camera;
  camera.verticalFovRad = 1.0f;
  builder.setCamera({0, 0, 0.9}, camera);
  Material paint, halfMirror, glass;
  paint.model = DiffuseModel{};
  halfMirror.phong().diffuse = Vec3{0.4f};
  halfMirror.phong().mirror = Vec3{0.4f};
  glass.model = DielectricModel{};
  const uint32_t matt = builder.addMaterial(paint), shiny = builder.addMaterial(halfMirror),
                 clear = builder.addMaterial(glass);
  const auto box = [&](double y, double half, uint32_t left, uint32_t others) {
    std::vector<double> positions;
    for (uint32_t k = 0; k < 8; ++k) {
      for (const double side :
           {k & 1 ? half : -half, k & 2 ? y + half : y - half, k & 4 ? half : -half})
        positions.push_back(side);
    }
    Mesh mesh{positions, {}, {}, {}};
    // Counter-clockwise from outside.
    const uint32_t sides[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                  {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (size_t s = 0; s < 6; ++s) {
      const uint32_t* c = sides[s];
      for (const auto& corners : {std::array{c[0], c[1], c[2]}, std::array{c[0], c[2], c[3]}})
        mesh.triangles.push_back({corners, kNoCorners, kNoCorners, s == 0 ? left : others});
    }
    builder.addMesh("box", std::move(mesh));
  };
  box(0.0, 1.0, shiny, matt);
  box(0.6, 0.1, clear, clear);
  LightSpec bulb;
  bulb.emission = Vec3(1.0f);
  builder.addLight(bulb, {0.02, 0.6, -0.03});
  return builder.finish();
}

// Photons contribute the light that walls reflect after it came through glass.
TEST(Guided, HasAllLightOfAPointLightInGlass) {
  const World world(bulbInGlass());
  const VplTable lit = fewLit(world);
  const auto light = [&](uint64_t seed) {
    return renderWithout(world, "light", {{"spp", "64"}, {"seed", typed(seed)}}).image;
  };
  EXPECT_TRUE(sameExpectation(light, guided(world, lit, {{"spp", "16"}})));
}

// Path reuse shares the light that a path finds: all of it at diffuse walls, bare or coated, the
// diffuse part at walls of glTF and of MTL's gloss, and none at metal.
TEST(Guided, SharedPathsHaveThePathTracersImage) {
  const auto ggx = [](float alpha) { return Roughness(Scalar(alpha), Roughness::Alpha::Same); };
  MetallicRoughnessModel gltf;
  gltf.baseColour = Vec3(0.3f, 0.7f, 0.9f);
  gltf.metallic = 0.4f;
  gltf.roughness = 0.7f;
  gltf.clearcoat = 0.5f;
  CoatedDiffuseModel coated;
  coated.reflectance = Vec3(0.8f, 0.4f, 0.2f);
  ConductorModel metal;
  metal.roughness = ggx(0.4f);
  PhongModel gloss;
  gloss.diffuse = Vec3{0.4f};
  gloss.glossy = Vec3{0.4f};
  gloss.exponent = 12.0f;
  const std::array<std::array<MaterialModel, 2>, 2> walls{{{gltf, coated}, {gloss, metal}}};
  for (const auto& models : walls) {
    Scene scene = loadScene(fs::path(BNVPL_SCENES_DIR) / "cornell/scene.toml");
    scene.film = {12, 12};
    for (Material& m : scene.materials) {
      if (m.name == "Green") m.model = models[0];
      if (m.name == "Red") m.model = models[1];
    }
    const World world(std::move(scene));
    const VplTable lit = fewLit(world);
    const Given indirect{{"only", "indirect"}};
    EXPECT_TRUE(sameExpectation(
        paths(world, with(indirect, {{"spp", "128"}})),
        guided(world, lit, with(indirect, {{"spp", "16"}, {"reuse", "16"}, {"paths", "2"}}))));
  }
}

// Shading normals alternate between two tilts, so that samples that reuse each other's vertices
// have different horizons. The guide, which knows none of them, draws directions below each.
TEST(Guided, HasThePathTracersImageOverNormalMaps) {
  Scene scene = loadScene(fs::path(BNVPL_SCENES_DIR) / "cornell/scene.toml");
  scene.film = {16, 16};
  addTextureCoordinates(scene);
  UvTransform fine;
  fine.a = fine.e = 200.0f;
  const auto tilted = [](float x) {
    return constantExpression(0.5f * normalize(Vec3{x, 0.0f, 1.0f}) + Vec3(0.5f));
  };
  scene.expressions = {tilted(1.0f), tilted(-1.0f), checkerboardExpression(0, 1, fine)};
  for (Material& m : scene.materials)
    if (m.name != "Lamp") m.relief.normalMap = 2;
  const World world(std::move(scene));
  const VplTable lit = fewLit(world);
  const Given indirect{{"only", "indirect"}};
  EXPECT_TRUE(sameExpectation(paths(world, with(indirect, {{"spp", "64"}})),
                              guided(world, lit, with(indirect, {{"spp", "16"}})), {.seeds = 64}));
}

// The VPLs have a wrong flux, and the guide takes nearly all directions.
TEST(Guided, HasThePathTracersImageByWrongVpls) {
  const World world = cornell(12);
  VplTable lit = fewLit(world);
  for (size_t i = 0; i < lit.size(); ++i) lit.flux[i] = i % 5 == 0 ? Vec3{100.0f} : Vec3{};
  const Given bounces{{"max-bounces", "3"}};
  const Render byPaths = remembered(paths(world, with(bounces, {{"spp", "64"}})));
  const Given few = with(bounces, {{"spp", "16"}, {"paths", "4"}});
  EXPECT_TRUE(sameExpectation(byPaths, guided(world, lit, few)));
  const Given bold = with(few, {{"guide-share", "0.9"}});
  EXPECT_TRUE(sameExpectation(byPaths, guided(world, lit, bold)));
}

// Light comes round a corner, which few paths find.
TEST(Guided, HasLessNoiseWhereLightComesRoundACorner) {
  World world("u-shape/scene.toml");
  world.scene.film = {32, 24};
  const VplTable lit = litVpls(world, {{"count", "600"}}, {{"photons", "200k"}}, {});
  const Given options{{"spp", "16"}, {"only", "indirect"}};
  const Given alone = with(options, {{"guide-share", "0"}});  // equal but for the guide
  EXPECT_LT(noiseOf(guided(world, lit, options), 3),
            0.7 * noiseOf(guided(world, lit, alone), 3));
}

TEST(Guided, IsTheSameForAnyThreads) {
  const World world = cornell(24);
  const VplTable lit = fewLit(world);
  std::vector<std::vector<float>> green;
  for (const size_t threads : {1u, 2u, 7u}) {
    const Image image = withThreads(threads, [&] {
      return guided(world, lit, {{"spp", "32"}})(1);
    });
    green.push_back(*image.find("G"));
  }
  EXPECT_EQ(green[0], green[1]);
  EXPECT_EQ(green[0], green[2]);
}

}  // namespace
}  // namespace bnvpl::test
