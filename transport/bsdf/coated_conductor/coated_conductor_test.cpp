// Lacquered metal.
#include "transport/bsdf/coated_conductor/coated_conductor.h"

#include "tests/support/bsdf_checks.h"
#include "transport/bsdf/fresnel.h"

namespace bnvpl::test {
namespace {

CoatedConductorModel lacquer(float metal, float coat) {
  CoatedConductorModel m;
  m.roughness = Roughness(Scalar(metal));
  m.coatRoughness = Roughness(Scalar(coat));
  return m;
}

TEST(CoatedConductor, KeepsToWhatEveryModelDoes) {
  for (const float metal : {0.0f, 0.2f, 0.5f})
    for (const float coat : {0.0f, 0.2f, 0.5f})
      check(materialOf(lacquer(metal, coat)),
            "lacquer " + std::to_string(coat) + " over " + std::to_string(metal), 0.05f);
}

// VPLs send on what rough metal reflects below its coat.
TEST(CoatedConductor, RoughMetalReflectsItsAlbedo) {
  for (const float alpha : {0.35f, 0.6f, 1.0f})
    for (const float thickness : {0.0f, 0.3f}) {
      CoatedConductorModel m = lacquer(alpha, 0.0f);
      m.roughness.alpha = Roughness::Alpha::Same;
      m.coatThickness = Scalar(thickness);
      const Scene scene = sceneOf(materialOf(m));
      for (const Vec3 wo : views()) {
        const SurfacePoint p = seenFrom(wo);
        const Bsdf bsdf(scene, p);
        expectClose(bsdf.exactRoughAlbedo(), meanWeight(bsdf, LobeGroup::Rough), 0.015f,
                    std::to_string(alpha) + " below " + std::to_string(thickness) + " from " +
                        std::to_string(wo.z));
      }
    }
}

// Below a smooth coat, a mirror of reflectance 1 returns all light after any number of bounces.
TEST(CoatedConductor, PerfectMirrorLosesNothing) {
  CoatedConductorModel m = lacquer(0, 0);
  m.fresnel.byReflectance = true;
  m.fresnel.reflectance = Vec3(1);
  for (const Vec3 wo : views()) EXPECT_NEAR(furnace(materialOf(m), wo).x, 1.0f, 2e-3f);
}

TEST(CoatedConductor, WithoutACoatIsTheMetal) {
  CoatedConductorModel coated = lacquer(0.2f, 0.0f);
  coated.coatIor = 1.0f;
  ConductorModel bare;
  bare.roughness = Roughness(Scalar(0.2f));
  bare.multipleScattering = false;
  for (const Vec3 wo : views())
    expectClose(furnace(materialOf(coated), wo), furnace(materialOf(bare), wo), 0.01f);
}

// At normal incidence: R + T^2 M / (1 - M R), with the metal's reflectance M against the coat.
TEST(CoatedConductor, NormalIncidenceHasTheClosedForm) {
  const float r = fresnelDielectric(1.0f, 1.5f),
              m = fresnelConductor(1.0f, 0.2f / 1.5f, 3.91f / 1.5f);
  EXPECT_NEAR(furnace(materialOf(lacquer(0, 0)), {0, 0, 1}).x,
              r + (1 - r) * (1 - r) * m / (1 - m * r), 1e-3f);
  CoatedConductorModel thick = lacquer(0, 0);  // light crosses the coat twice for each reflection
  thick.coatThickness = Scalar(0.5f);
  const float kept = m * std::exp(-1.0f);
  EXPECT_NEAR(furnace(materialOf(thick), {0, 0, 1}).x,
              r + (1 - r) * (1 - r) * kept / (1 - kept * r), 1e-3f);
}

}  // namespace
}  // namespace bnvpl::test
