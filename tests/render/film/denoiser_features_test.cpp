// What denoisers are told of surfaces, against known values of mirrors, metals, coats and glass.
#include "tools/render/film/features/denoiser_features.h"

#include <gtest/gtest.h>

#include "scene/builder/scene_builder.h"
#include "tests/transport/plain_scene.h"

namespace bnvpl {
namespace {

const Vec3 kWall{0.8f, 0.4f, 0.2f};

Material materialOf(const MaterialModel& model) {
  Material m;
  m.model = model;
  return m;
}
ConductorModel metal(Vec3 reflectance, float alpha) {
  ConductorModel m;
  m.fresnel.byReflectance = true;
  m.fresnel.reflectance = Colour(reflectance);
  m.roughness = Roughness(Scalar(alpha));
  return m;
}
CoatedDiffuseModel varnish(Vec3 reflectance) {
  CoatedDiffuseModel m;
  m.reflectance = Colour(reflectance);
  return m;
}

// The square z = 0 of the material, seen from `from` in the direction to its centre, and the wall
// z = 10 above or z = -10 below it, which is far wider.
enum class Wall { Above, Below, None };
DenoiserFeatures seen(const Material& material, Wall wall, Vec3 from = {0, 0, 5},
                      int draws = 4000) {
  Scene scene;
  addSquare(scene, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, material);
  if (wall == Wall::Above)
    addSquare(scene, {-200, -200, 10}, {0, 400, 0}, {400, 0, 0}, lambert(kWall));
  if (wall == Wall::Below)
    addSquare(scene, {-200, -200, -10}, {400, 0, 0}, {0, 400, 0}, lambert(kWall));
  finishScene(scene);
  const Accelerator accel(scene);
  DenoiserFeatures sum;
  for (int i = 0; i < draws; ++i) {
    Rng rng(streamKey(42, RandomStream::PixelSamples), uint64_t(i));
    SurfacePoint hit;
    EXPECT_TRUE(accel.closestHit(from, normalize(-from), hit));
    sum += denoiserFeatures(accel, hit, rng);
  }
  const float each = 1.0f / float(draws);
  return {sum.albedo * each, sum.normal * each};
}
void expectFeatures(const DenoiserFeatures& f, Vec3 albedo, Vec3 normal, float tolerance) {
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(f.albedo[c], albedo[c], tolerance) << c;
    EXPECT_NEAR(f.normal[c], normal[c], tolerance) << c;
  }
}

const Vec3 kUp{0, 0, 1}, kDown{0, 0, -1};

TEST(DenoiserFeatures, MattSurfacesHaveTheirOwn) {
  expectFeatures(seen(lambert({0.5f, 0.3f, 0.1f}), Wall::Above), {0.5f, 0.3f, 0.1f}, kUp, 1e-4f);
  expectFeatures(seen(lambert({0.5f, 0.3f, 0.1f}), Wall::None, {3, 0, -3}), {0.5f, 0.3f, 0.1f},
                 kDown, 1e-4f);
}

// Rough and brushed metals have their reflectance, whatever they mirror; on rough ones, light that
// is reflected more than once is darker.
TEST(DenoiserFeatures, MetalsHaveTheirReflectance) {
  const Vec3 gold{1.0f, 0.78f, 0.34f};
  for (const float alpha : {0.05f, 0.2f, 0.5f}) {
    for (const Wall wall : {Wall::Above, Wall::None})
      expectFeatures(seen(materialOf(metal(gold, alpha)), wall), gold, kUp,
                     alpha < 0.3f ? 0.04f : 0.08f);
  }
}

// A perfect mirror shows what it reflects; its normal is that of what is seen there, of full
// length.
TEST(DenoiserFeatures, MirrorsShowWhatTheyReflect) {
  const Vec3 silver{0.9f, 0.5f, 0.25f};
  expectFeatures(seen(materialOf(metal(silver, 0.0f)), Wall::Above, {0.5f, 0, 5}), silver * kWall,
                 kDown, 0.01f);
  expectFeatures(seen(materialOf(metal(silver, 0.0f)), Wall::None), {}, {}, 0.0f);
  Material phong = lambert({});
  phong.phong().mirror = silver;
  expectFeatures(seen(phong, Wall::Above), silver * kWall, kDown, 1e-4f);
}

// At normal incidence varnish of index 1.5 reflects 4 %. Under it, a white base returns the rest.
TEST(DenoiserFeatures, VarnishAddsWhatItReflects) {
  const DenoiserFeatures white = seen(materialOf(varnish(Vec3(1.0f))), Wall::Above);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(white.albedo[c], 0.96f + 0.04f * kWall[c], 0.012f) << c;
  EXPECT_GT(white.normal.z, 0.9f);
  const DenoiserFeatures alone = seen(materialOf(varnish(Vec3(0.3f))), Wall::None),
                         before = seen(materialOf(varnish(Vec3(0.3f))), Wall::Above);
  expectFeatures({before.albedo - alone.albedo, {}}, 0.04f * kWall, {}, 1e-3f);
  EXPECT_GT(alone.albedo.x, 0.1f);
  EXPECT_LT(alone.albedo.x, 0.3f);
  // The base keeps its share of the normal; what the coat shows takes the rest.
  EXPECT_NEAR(before.normal.z, 2.0f * alone.normal.z - 1.0f, 0.01f);
  CoatedConductorModel lacquered;
  lacquered.fresnel = metal(Vec3(0.8f), 0.3f).fresnel;
  lacquered.roughness = Roughness(Scalar(0.3f));
  const DenoiserFeatures metal = seen(materialOf(lacquered), Wall::None);
  EXPECT_GT(metal.albedo.x, 0.6f);
  EXPECT_LT(metal.albedo.x, 0.8f);
}

// A sheet reflects 2F / (1 + F) at normal incidence.
TEST(DenoiserFeatures, GlassShowsWhatIsBehindItAndWhatItReflects) {
  DielectricModel sheet;
  sheet.thin = true;
  const float reflected = 0.08f / 1.04f;
  expectFeatures(seen(materialOf(sheet), Wall::Below), (1.0f - reflected) * kWall,
                 (1.0f - reflected) * kUp, 0.02f);
  expectFeatures(seen(materialOf(sheet), Wall::Above), reflected * kWall, reflected * kDown, 0.02f);
  // Total reflection from within: the outside is below.
  DielectricModel solid;
  expectFeatures(seen(materialOf(solid), Wall::Below, {4, 0, -3}), kWall, kUp, 0.02f);
}

TEST(DenoiserFeatures, TexturesColourTheAlbedo) {
  Scene scene;
  DiffuseModel painted;
  painted.reflectance = Colour(Vec3(1.0f), 0);
  addSquare(scene, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, materialOf(painted));
  scene.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (Triangle& t : scene.triangles) t.uv = t.position;
  Texture texture;
  texture.width = 2, texture.height = 1, texture.srgb = false;
  texture.rgba = {255, 0, 51, 255, 0, 102, 204, 255};
  scene.textures.push_back(texture);
  scene.expressions.push_back(imageExpression(0));
  finishScene(scene);
  const Accelerator accel(scene);
  for (const auto& [x, albedo] :
       {std::pair{-0.5f, Vec3(1, 0, 0.2f)}, std::pair{0.5f, Vec3(0, 0.4f, 0.8f)}}) {
    SurfacePoint hit;
    ASSERT_TRUE(accel.closestHit({x, 0.2f, 5}, {0, 0, -1}, hit));
    Rng rng(1, 1);
    expectFeatures(denoiserFeatures(accel, hit, rng), albedo, kUp, 0.01f);
  }
}

}  // namespace
}  // namespace bnvpl
