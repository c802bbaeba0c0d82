// Plastic: the checks for every model, and the energy between base and coat.
#include "transport/bsdf/coated_diffuse/coated_diffuse.h"

#include "tests/support/bsdf_checks.h"
#include "transport/bsdf/fresnel.h"

namespace bnvpl::test {
namespace {

CoatedDiffuseModel plastic(Vec3 base, float alpha, float ior = 1.5f) {
  return {base, ior, Roughness(Scalar(alpha))};
}

TEST(CoatedDiffuse, KeepsToWhatEveryModelDoes) {
  for (const float alpha : {0.0f, 0.1f, 0.3f, 0.6f, 1.0f})
    check(materialOf(plastic({0.8f, 0.4f, 0.1f}, alpha)), "plastic " + std::to_string(alpha));
  check(materialOf(plastic(Vec3(0.5f), 0.2f, 2.2f)), "glaze");
}

// A white base returns all light that the coat transmits: nothing is lost, whatever the coat.
TEST(CoatedDiffuse, WhiteBaseLosesNothing) {
  for (const float ior : {1.2f, 1.5f, 2.5f}) {
    for (const float alpha : {0.0f, 0.1f, 0.4f, 1.0f}) {
      for (const Vec3 wo : views())
        EXPECT_NEAR(furnace(materialOf(plastic(Vec3(1), alpha, ior)), wo).x, 1.0f, 0.01f)
            << ior << " " << alpha << " " << wo.z;
    }
  }
}

// The smooth coat of Mitsuba's "plastic" (Jakob 2010): (1 - F)(1 - F) rho / (pi n^2 (1 - rho Fdr)),
// with Fdr = 0.5963 inside an index of 1.5.
TEST(CoatedDiffuse, SmoothCoatHasTheClosedForm) {
  const float rho = 0.6f, inside = 0.5963f;
  const Scene scene = sceneOf(materialOf(plastic(Vec3(rho), 0.0f)));
  const Vec3 wi = normalize({-0.2f, 0.5f, 0.7f});
  for (const Vec3 wo : views()) {
    const SurfacePoint p = seenFrom(wo);
    const float closed = (1 - fresnelDielectric(wo.z, 1.5f)) * (1 - fresnelDielectric(wi.z, 1.5f)) *
                         rho / (kPi * 2.25f * (1 - rho * inside));
    EXPECT_NEAR(Bsdf(scene, p).eval(LobeGroup::Rough, wi).x / wi.z, closed, 2e-3f * closed);
    EXPECT_NEAR(meanWeight(Bsdf(scene, p), LobeGroup::Specular).x, fresnelDielectric(wo.z, 1.5f),
                1e-4f);
  }
}

// A walk between coat and base as pbrt's: light that crosses the coat at cosine c keeps
// exp(-thickness / c). Returns what leaves of what arrives along wo.
float walked(float rho, float thickness, float cosine) {
  const float ior = 1.5f, reflected = fresnelDielectric(cosine, ior);
  const auto kept = [&](float c) { return std::exp(-thickness / c); };
  constexpr int kWalks = 40000;
  double out = 0.0;
  for (int i = 0; i < kWalks; ++i) {
    Rng rng(3, uint64_t(i));
    float weight = (1.0f - reflected) * kept(refractedCosine(cosine, ior));
    while (weight > 1e-4f) {
      const float c = std::sqrt(std::max(1e-6f, rng.next()));  // Lambert's law
      weight *= rho * kept(c);
      const float back = fresnelDielectric(c, 1.0f / ior);
      out += double{weight * (1.0f - back)};
      weight *= back * kept(c);
    }
  }
  return reflected + float(out / kWalks);
}
TEST(CoatedDiffuse, ThickCoatsAbsorbAsAWalkThroughThemDoes) {
  for (const float rho : {0.3f, 0.9f}) {
    for (const float thickness : {0.01f, 0.1f, 0.5f, 2.0f}) {
      CoatedDiffuseModel m = plastic(Vec3(rho), 0.0f);
      m.thickness = Scalar(thickness);
      for (const Vec3 wo : views()) {
        const float expected = walked(rho, thickness, wo.z);
        EXPECT_NEAR(furnace(materialOf(m), wo).x, expected, 0.01f * expected + 0.002f)
            << rho << " " << thickness << " " << wo.z;
      }
      check(materialOf(m), "thick plastic " + std::to_string(thickness));
    }
  }
}

TEST(CoatedDiffuse, WithoutACoatIsLambert) {
  const Scene scene = sceneOf(materialOf(plastic(Vec3(0.5f), 0.3f, 1.0f)));
  const SurfacePoint p = seenFrom(views()[1]);
  EXPECT_NEAR(Bsdf(scene, p).eval(LobeGroup::Rough, {0, 0, 1}).x, 0.5f / kPi, 1e-3f);
}

// The coat's lobe is specular while the coat is smooth; the base never is.
TEST(CoatedDiffuse, GroupsFollowTheCoatsAlpha) {
  for (const float alpha : {0.1f, 0.4f}) {
    const Scene scene = sceneOf(materialOf(plastic(Vec3(0.5f), alpha)));
    const SurfacePoint p = seenFrom({0, 0, 1});
    EXPECT_EQ(Bsdf(scene, p).specularProbability() > 0.0f, alpha < kRoughAlpha);
    EXPECT_TRUE(Bsdf(scene, p).hasRough());
    EXPECT_FALSE(Bsdf(scene, p).diffuseOnly());
  }
}

}  // namespace
}  // namespace bnvpl::test
