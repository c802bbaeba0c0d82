// Lambert with textures.
#include "transport/bsdf/diffuse/diffuse.h"

#include "tests/support/bsdf_checks.h"

namespace bnvpl::test {
namespace {

TEST(Diffuse, KeepsToWhatEveryModelDoes) {
  check(materialOf(DiffuseModel{Vec3(0.8f, 0.5f, 0.1f)}), "diffuse", 1e-3f);
  check(materialOf(DiffuseModel{Vec3(3)}), "more than white", 1e-3f);
}

TEST(Diffuse, IsLambertsLaw) {
  const Scene scene = sceneOf(materialOf(DiffuseModel{Vec3(0.8f, 0.5f, 0.1f)}));
  const SurfacePoint p = seenFrom(views()[1]);
  const Bsdf bsdf(scene, p);
  expectClose(bsdf.eval(LobeGroup::Rough, {0, 0, 1}), Vec3(0.8f, 0.5f, 0.1f) / kPi, 1e-5f);
  expectClose(bsdf.diffuseValue(), Vec3(0.8f, 0.5f, 0.1f) / kPi, 1e-5f);
  EXPECT_TRUE(bsdf.diffuseOnly());
  EXPECT_EQ(bsdf.specularProbability(), 0.0f);
  EXPECT_FALSE(hasSpecularLobes(scene));
  EXPECT_EQ(bsdf.eval(LobeGroup::Rough, {0, 0, -1}), Vec3());
}

// Where the mesh has no texture coordinates the constant counts alone.
TEST(Diffuse, TexturesScaleTheConstant) {
  Scene scene = sceneOf(materialOf(DiffuseModel{{Vec3(0.8f), 0}}));
  scene.expressions.push_back(constantExpression({0.5f, 0.25f, 1}));
  SurfacePoint p = seenFrom({0, 0, 1});
  p.u = 0.3f, p.v = 0.2f;
  expectClose(Bsdf(scene, p).roughAlbedo(), {0.4f, 0.2f, 0.8f}, 1e-6f);
  p.u = NAN;
  expectClose(Bsdf(scene, p).roughAlbedo(), Vec3(0.8f), 1e-6f);
}

// From behind the shading normal's horizon Lambert is lit as from anywhere: no black seams.
TEST(Diffuse, HasNoSeamsWhereTheShadingNormalTurnsAway) {
  const Scene scene = sceneOf(materialOf(DiffuseModel{Vec3(0.5f)}));
  const Vec3 ns = normalize({0.8f, 0, 0.6f});
  const SurfacePoint away = seenFrom(normalize({-1, 0, 0.3f}), ns),
                     towards = seenFrom({0, 0, 1}, ns);
  EXPECT_LT(dot(away.ns, away.wo), 0.0f);
  const Vec3 wi = normalize({0.3f, 0, 1});
  EXPECT_EQ(Bsdf(scene, away).eval(LobeGroup::Rough, wi),
            Bsdf(scene, towards).eval(LobeGroup::Rough, wi));
}

}  // namespace
}  // namespace bnvpl::test
