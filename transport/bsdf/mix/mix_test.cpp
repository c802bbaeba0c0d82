// Weighted sums of materials.
#include "transport/bsdf/mix/mix.h"

#include "tests/support/bsdf_checks.h"

namespace bnvpl::test {
namespace {

// The mix is material 0, which points refer to; its parts follow.
void addMaterial(Scene& scene, const char* name, const MaterialModel& model) {
  Material m;
  m.name = name;
  m.model = model;
  scene.materials.push_back(m);
}

Scene mixed(const MaterialModel& first, const MaterialModel& second, Scalar amount) {
  Scene scene = sceneOf(materialOf(MixModel{1, 2, amount}));
  addMaterial(scene, "first", first);
  addMaterial(scene, "second", second);
  return scene;
}

TEST(Mix, IsTheWeightedSum) {
  const CoatedDiffuseModel plastic{Vec3(0.7f), 1.5f, Roughness(Scalar(0.4f))};
  ConductorModel metal;
  metal.roughness = Roughness(Scalar(0.1f));
  const Scene scene = mixed(plastic, metal, 0.3f), first = sceneOf(materialOf(plastic)),
              second = sceneOf(materialOf(metal));
  const SurfacePoint p = seenFrom(views()[1]);
  const Bsdf sum(scene, p), a(first, p), b(second, p);
  for (const LobeGroup group : kGroups) {
    Rng rng(1, 1);
    for (int i = 0; i < 100; ++i) {
      const float u = rng.next(), v = rng.next();
      const Vec3 wi = sampleCosineHemisphere(u, v);
      expectClose(sum.eval(group, wi), 0.7f * a.eval(group, wi) + 0.3f * b.eval(group, wi), 1e-4f);
    }
    checkDensity(sum, group, "mix");
    checkSamples(scene, views()[1], {0, 0, 1}, group, "mix");
  }
  checkBound(sum, "mix");
}

TEST(Mix, TexturesChoose) {
  Scene scene = mixed(DiffuseModel{Vec3(0.2f)}, DiffuseModel{Vec3(0.8f)}, {1.0f, 2});
  scene.expressions = {constantExpression(Vec3(0)), constantExpression(Vec3(1)),
                       checkerboardExpression(0, 1, {2, 0, 0, 0, 1, 0})};
  SurfacePoint p = seenFrom({0, 0, 1});
  p.v = 0.5f;
  p.u = 0.25f;
  EXPECT_FLOAT_EQ(Bsdf(scene, p).roughAlbedo().x, 0.2f);
  p.u = 0.75f;
  EXPECT_FLOAT_EQ(Bsdf(scene, p).roughAlbedo().x, 0.8f);
}

TEST(Mix, OfMixesEndsAtTheMostLobes) {
  Scene scene = mixed(MixModel{3, 3, 0.5f}, MixModel{3, 3, 0.5f}, 0.5f);
  addMaterial(scene, "third", MixModel{4, 4, 0.5f});
  addMaterial(scene, "plastic", CoatedDiffuseModel{});
  // Eight of the sixteen lobes are kept: those of the first four of eight equal parts.
  const SurfacePoint p = seenFrom({0, 0, 1});
  const Scene plastic = sceneOf(materialOf(CoatedDiffuseModel{}));
  const Bsdf sum(scene, p), part(plastic, p);
  expectClose(sum.roughAlbedo(), 0.5f * part.roughAlbedo(), 1e-5f);
  expectClose(sum.albedo(), 0.5f * part.albedo(), 1e-5f);
}

}  // namespace
}  // namespace bnvpl::test
