// Glass: the checks for every model, and the Fresnel equations.
#include "transport/bsdf/dielectric/dielectric.h"

#include "tests/support/bsdf_checks.h"
#include "transport/bsdf/fresnel.h"

namespace bnvpl::test {
namespace {

DielectricModel glass(float alpha, float ior = 1.5f) {
  DielectricModel m;
  m.ior = ior;
  m.roughness = Roughness(Scalar(alpha));
  return m;
}

TEST(Dielectric, KeepsToWhatEveryModelDoes) {
  for (const float alpha : {0.0f, 0.1f, 0.3f, 0.7f, 1.0f})
    check(materialOf(glass(alpha)), "glass " + std::to_string(alpha));
  check(materialOf(glass(0.2f, 2.4f)), "diamond");
  DielectricModel thin = glass(0.0f);
  thin.thin = true;
  check(materialOf(thin), "sheet");
}

// Partial opacity lets light through unchanged, also where a normal map faces away from the viewer.
TEST(Dielectric, StraightLightPassesWhateverTheShadingNormal) {
  DielectricModel nothing = glass(0.0f, 1.0f);
  nothing.thin = true;
  const Scene scene = sceneOf(materialOf(nothing));
  SurfacePoint p = seenFrom(normalize(Vec3(1, 0, 0.15f)));
  p.ns = normalize(Vec3(-0.5f, 0, 0.8f));
  ASSERT_LT(dot(p.ns, p.wo), 0.0f);
  for (const auto transport : {TransportMode::Radiance, TransportMode::Importance}) {
    BsdfSample s;
    ASSERT_TRUE(Bsdf(scene, p).sample(LobeGroup::Specular, transport, 0.3f, {0.4f, 0.6f}, s));
    expectClose(s.wi, -p.wo, 1e-5f);
    expectClose(s.weight, Vec3(1), 1e-5f);
  }
}

struct Split {
  float reflected = 0.0f, crossed = 0.0f;
};
Split split(const DielectricModel& m, Vec3 wo, TransportMode transport, bool inside = false) {
  const Scene scene = sceneOf(materialOf(m));
  const SurfacePoint p = seenFrom(wo, {0, 0, 1}, inside);
  Split out;
  forEachSample(Bsdf(scene, p), LobeGroup::Specular, transport, 1u << 16, [&](const BsdfSample& s) {
    (s.wi.z > 0.0f ? out.reflected : out.crossed) += s.weight.x / (1u << 16);
  });
  return out;
}

TEST(Dielectric, SmoothSplitsByFresnelAndSnell) {
  for (const Vec3 wo : views()) {
    const float f = fresnelDielectric(wo.z, 1.5f);
    const Split flux = split(glass(0), wo, TransportMode::Importance);
    EXPECT_NEAR(flux.reflected, f, 0.01f);
    EXPECT_NEAR(flux.crossed, 1.0f - f, 0.01f);
    EXPECT_NEAR(split(glass(0), wo, TransportMode::Radiance).crossed, (1.0f - f) / 2.25f, 0.01f);
    EXPECT_NEAR(split(glass(0), wo, TransportMode::Radiance, true).crossed,
                (1.0f - fresnelDielectric(wo.z, 1 / 1.5f)) * 2.25f, 0.02f);
  }
  const Scene scene = sceneOf(materialOf(glass(0)));
  const SurfacePoint p = seenFrom(normalize({1, 0, 1}));
  BsdfSample s;
  ASSERT_TRUE(
      Bsdf(scene, p).sample(LobeGroup::Specular, TransportMode::Radiance, 0.999f, {0.5f, 0.5f}, s));
  EXPECT_NEAR(s.wi.x, -std::sqrt(0.5f) / 1.5f, 1e-5f);
  EXPECT_LT(s.wi.z, 0.0f);
  EXPECT_EQ(s.side, Vec3(0, 0, -1));
  EXPECT_NEAR(fresnelDielectric(1.0f, 1.5f), 0.04f, 1e-6f);
  const float brewster = std::cos(std::atan(1.5f));  // all reflected light has one polarisation
  const float sine = std::sqrt(1 - brewster * brewster), t = std::asin(sine / 1.5f),
              i = std::asin(sine);
  EXPECT_NEAR(fresnelDielectric(brewster, 1.5f),
              0.5f * std::pow(std::sin(i - t) / std::sin(i + t), 2.0f), 1e-5f);
}

TEST(Dielectric, ReflectsTotallyInside) {
  const Split flux = split(glass(0), normalize({2, 0, 1}), TransportMode::Importance, true);
  EXPECT_FLOAT_EQ(flux.reflected, 1.0f);
  EXPECT_EQ(flux.crossed, 0.0f);
}

// Air in water: the index of the inside is below that of the outside.
TEST(Dielectric, MayBeThinnerThanItsSurroundings) {
  const DielectricModel bubble = glass(0, 0.75f);
  const Split steep = split(bubble, normalize({0.4f, 0, 1}), TransportMode::Importance);
  const float f = fresnelDielectric(1 / std::sqrt(1.16f), 0.75f);
  EXPECT_GT(f, 0.015f);
  EXPECT_NEAR(steep.reflected, f, 0.01f);
  EXPECT_NEAR(steep.crossed, 1.0f - f, 0.01f);
  const Split grazing = split(bubble, normalize({2, 0, 1}), TransportMode::Importance);
  EXPECT_FLOAT_EQ(grazing.reflected, 1.0f);
  EXPECT_EQ(grazing.crossed, 0.0f);
  check(materialOf(bubble), "bubble");
}

// For small alpha, rough glass approaches smooth glass.
TEST(Dielectric, RoughnessHasTheSmoothLimit) {
  for (const bool inside : {false, true}) {
    const Vec3 wo = normalize({0.4f, 0.1f, 1});
    const Split rough = split(glass(0.01f), wo, TransportMode::Radiance, inside),
                smooth = split(glass(0), wo, TransportMode::Radiance, inside);
    EXPECT_NEAR(rough.reflected, smooth.reflected, 0.01f);
    EXPECT_NEAR(rough.crossed, smooth.crossed, 0.02f);
  }
}

// The energy lost between facets is that stated in theory.md.
TEST(Dielectric, LossIsAsStated) {
  const Vec3 wo = normalize({0.5f, 0, 1});
  EXPECT_NEAR(1.0f - furnace(materialOf(glass(0.3f)), wo).x, 0.01f, 0.01f);
  EXPECT_NEAR(1.0f - furnace(materialOf(glass(1.0f)), wo).x, 0.15f, 0.08f);
}

TEST(Dielectric, ThinSheetSumsItsReflections) {
  DielectricModel m = glass(0);
  m.thin = true;
  for (const Vec3 wo : views()) {
    const float f = fresnelDielectric(wo.z, 1.5f);
    const Split flux = split(m, wo, TransportMode::Radiance);
    EXPECT_NEAR(flux.reflected, 2 * f / (1 + f), 0.01f);
    EXPECT_NEAR(flux.crossed, 1 - 2 * f / (1 + f), 0.01f);
  }
  const Scene scene = sceneOf(materialOf(m));
  const SurfacePoint p = seenFrom(views()[1]);
  BsdfSample s;
  ASSERT_TRUE(Bsdf(scene, p).sample(LobeGroup::Specular, TransportMode::Importance, 0.999f,
                                    {0.5f, 0.5f}, s));
  EXPECT_LT(length(s.wi + p.wo), 1e-5f);
}

TEST(Dielectric, PassesPathsThroughWhateverItsRoughness) {
  for (const float alpha : {0.0f, 1.0f}) {
    const Scene scene = sceneOf(materialOf(glass(alpha)));
    const SurfacePoint p = seenFrom({0, 0, 1});
    EXPECT_FALSE(Bsdf(scene, p).hasRough());
    EXPECT_EQ(Bsdf(scene, p).specularProbability(), 1.0f);
    EXPECT_EQ(Bsdf(scene, p).specularIsDelta(), alpha == 0.0f);
  }
}

}  // namespace
}  // namespace bnvpl::test
