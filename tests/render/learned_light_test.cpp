// Direct light by what tiles learned, against one ray to each light: one mean, less noise.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/pipeline.h"
#include "tests/support/z_test.h"

namespace bnvpl::test {
namespace {

Scene room(uint32_t width, uint32_t height) {
  Scene scene = loadScene(fs::path(BNVPL_SCENES_DIR) / "cornell/scene.toml");
  scene.film = {width, height};
  return scene;
}

// A box that is open to the viewer, under lamp, sky with an image, sun and bulb.
Scene manyLights() {
  Scene scene = room(24, 24);
  EnvironmentImage sky;
  sky.width = 16;
  sky.height = 8;
  for (uint32_t i = 0; i < 128; ++i)
    sky.radiance.push_back(Vec3(i / 16 == 3 ? 20.0f : 0.5f + toUnitFloat(random64(1, i, 0))));
  scene.environments.push_back(std::move(sky));
  scene.lights.resize(3);
  scene.lights[0].type = LightType::Environment;
  scene.lights[0].image = 0;
  scene.lights[1].type = LightType::Directional;
  scene.lights[1].direction = normalize(Vec3{0.3f, -0.4f, -1});
  scene.lights[1].angularRadiusRad = 0.03f;
  scene.lights[1].emission = Vec3{20.0f};
  scene.lights[2].position = scene.bounds.center();
  scene.lights[2].emission = Vec3{scene.bounds.diagonal() * scene.bounds.diagonal()} * 0.05f;
  return scene;
}

const Given kDirect = with(kPlainDirect, {{"compensate", "near-field"}, {"near-field-rays", "2"}});

Render directBy(const World& world, const Given& options) {
  return [&world, options = with(kDirect, options)](uint64_t seed) {
    return renderVpls(world, {}, with(options, {{"seed", typed(seed)}})).image;
  };
}

double noiseOf(const Render& render) {
  const Image a = render(1), b = render(2);
  double sum = 0.0;
  for (const char* channel : {"R", "G", "B"}) {
    const std::vector<float>&p = *a.find(channel), &q = *b.find(channel);
    for (size_t i = 0; i < p.size(); ++i) sum += std::pow(double{p[i]} - double{q[i]}, 2);
  }
  return std::sqrt(sum);
}

TEST(LearnedLight, IsTheLightOfAllLights) {
  const World world(manyLights());
  EXPECT_TRUE(sameExpectation(directBy(world, {{"direct", "learned"}, {"spp", "8"}}),
                              directBy(world, {{"direct", "each"}, {"spp", "16"}})));
}

// The box without its lamp, with three bulbs inside and more above its ceiling than there are
// strata.
Scene bulbs(uint32_t hidden) {
  Scene scene = room(24, 24);
  const Vec3 centre = scene.bounds.center(), extent = scene.bounds.extent();
  for (Material& m : scene.materials) m.emission = {};
  for (uint32_t k = 0; k < 3 + hidden; ++k) {
    LightSpec& s = scene.lights.emplace_back();
    s.position = centre + Vec3{float(k % 3) * 0.2f - 0.2f, 0.2f, 0.2f} * extent;
    if (k >= 3) s.position.y += extent.y * (0.6f + 0.4f * toUnitFloat(random64(3, k, 0)));
    s.emission = Vec3{1.0f};
  }
  return scene;
}

TEST(LearnedLight, FindsTheFewLightsThatAreSeen) {
  const World few(bulbs(0)), many(bulbs(1200));
  const Render learned = directBy(many, {{"direct", "learned"}}),
               each = directBy(many, {{"direct", "each"}});
  EXPECT_TRUE(sameExpectation(learned, directBy(few, {{"direct", "each"}})));
  EXPECT_LT(noiseOf(learned), 0.3 * noiseOf(each));
}

// A lamp that the camera sees: its border is as sharp as many rays make it.
TEST(LearnedLight, BordersOfSeenLightHaveLessNoise) {
  Scene scene = room(32, 32);
  for (Material& m : scene.materials) {
    m.phong().diffuse = {};  // what is left is what the camera sees
    if (!isBlack(m.emission)) m.twoSidedEmission = true;
  }
  const World world(std::move(scene));
  const Given few{{"spp", "4"}};
  const Render learned = directBy(world, with(few, {{"direct", "learned"}})),
               each = directBy(world, with(few, {{"direct", "each"}}));
  EXPECT_TRUE(sameExpectation(learned, each));
  EXPECT_LT(noiseOf(learned), 0.5 * noiseOf(each));
}

}  // namespace
}  // namespace bnvpl::test
