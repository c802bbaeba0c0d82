// MTL's model: the checks for every model, and the energy of the Phong lobe.
#include "transport/bsdf/phong/phong.h"

#include "tests/support/bsdf_checks.h"

namespace bnvpl::test {
namespace {

PhongModel phong(Vec3 kd, Vec3 ks, float exponent) {
  PhongModel m;
  m.diffuse = kd, m.glossy = ks, m.exponent = exponent;
  return m;
}

TEST(Phong, KeepsToWhatEveryModelDoes) {
  for (const float exponent : {0.0f, 4.0f, 20.0f, 21.0f, 150.0f, 900.0f})
    check(materialOf(phong(Vec3(0.4f), {0.3f, 0.4f, 0.5f}, exponent)),
          "exponent " + std::to_string(exponent));
  PhongModel mirror = phong({0.5f, 0.2f, 0.1f}, {}, 10);
  mirror.mirror = {0.3f, 0.3f, 0.2f};
  check(materialOf(mirror), "mirror");
  PhongModel glass;
  glass.glass = true;
  glass.mirror = Vec3(1);
  check(materialOf(glass), "glass");
}

// VPLs send on the albedo of rough lobes, so it is exact at all angles.
TEST(Phong, RoughLobeReflectsItsAlbedo) {
  for (const float exponent : {0.0f, 0.5f, 1.0f, 5.0f, 20.0f}) {
    const Scene scene = sceneOf(materialOf(phong({}, Vec3(1), exponent)));
    for (const float cosine : {1.0f, 0.9f, 0.6f, 0.3f, 0.1f, 0.02f}) {
      const SurfacePoint p = seenFrom({std::sqrt(1 - cosine * cosine), 0, cosine});
      const Bsdf bsdf(scene, p);
      EXPECT_NEAR(bsdf.roughAlbedo().x, meanWeight(bsdf, LobeGroup::Rough).x, 0.006f)
          << exponent << " at " << cosine;
    }
  }
  // For n = 1 and wo in the surface, half of the hemisphere about it counts: 1/pi of the lobe.
  EXPECT_NEAR(phongAlbedo(0.0f, 1.0f), 1.0f / kPi, 0.003f);
}

// In a white furnace, all of Kd + Ks returns at normal incidence. At grazing incidence the lobe
// loses the part that lies below the horizon.
TEST(Phong, FurnaceReturnsWhatTheoryStates) {
  for (const float exponent : {1.0f, 4.0f, 20.0f, 100.0f}) {
    const Material m = materialOf(phong(Vec3(0.3f), Vec3(0.6f), exponent));
    EXPECT_NEAR(furnace(m, {0, 0, 1}).x, 0.9f, 5e-3f) << exponent;
    EXPECT_LT(furnace(m, views()[2]).x, 0.9f) << exponent;
    EXPECT_GT(furnace(m, views()[2]).x, 0.3f) << exponent;
  }
}

TEST(Phong, ScalesDownWhatExceedsOne) {
  const Material m = materialOf(phong({0.9f, 0.8f, 0.1f}, {0.7f, 0.8f, 0.3f}, 8));
  const Scene scene = sceneOf(m);
  const SurfacePoint p = seenFrom({0, 0, 1});
  expectClose(Bsdf(scene, p).roughAlbedo(), {1.0f, 1.0f, 0.25f}, 1e-5f);
  expectClose(furnace(m, {0, 0, 1}), {1.0f, 1.0f, 0.25f}, 5e-3f);
}

// MTL's glass is the smooth dielectric of the same index.
TEST(Phong, GlassIsTheDielectric) {
  PhongModel glass;
  glass.glass = true;
  glass.ior = 1.33f;
  glass.mirror = Vec3(0.9f);
  DielectricModel dielectric;
  dielectric.ior = 1.33f;
  dielectric.reflection = Vec3(0.9f);
  for (const Vec3 wo : views())
    EXPECT_EQ(furnace(materialOf(glass), wo), furnace(materialOf(dielectric), wo));
}

// A mix takes the lobes of MTL's model as those of any other.
TEST(Phong, MixesWithOtherModels) {
  Scene scene = sceneOf(materialOf(MixModel{1, 2, 0.25f}));
  scene.materials.push_back(materialOf(phong(Vec3(0.2f), Vec3(0.5f), 8)));
  scene.materials.push_back(materialOf(DiffuseModel{Vec3(0.8f)}));
  const SurfacePoint p = seenFrom(views()[1]);
  const Bsdf sum(scene, p);
  const float glossy = 0.5f * phongAlbedo(views()[1].z, 8);
  expectClose(sum.roughAlbedo(), Vec3(0.75f * (0.2f + glossy) + 0.25f * 0.8f), 1e-5f);
  checkSamples(scene, views()[1], {0, 0, 1}, LobeGroup::Rough, "mix");
}

}  // namespace
}  // namespace bnvpl::test
