// Metals: the checks for every model, and known numbers.
#include "transport/bsdf/conductor/conductor.h"

#include <complex>

#include "tests/support/bsdf_checks.h"
#include "transport/bsdf/fresnel.h"

namespace bnvpl::test {
namespace {

ConductorModel metal(float along, float across, bool multipleScattering = true) {
  ConductorModel m;
  m.roughness = Roughness(along, across, Roughness::Alpha::Same);
  m.multipleScattering = multipleScattering;
  return m;
}
ConductorModel white(float alpha, bool multipleScattering) {
  ConductorModel m = metal(alpha, alpha, multipleScattering);
  m.fresnel.byReflectance = true;
  m.fresnel.reflectance = Vec3(1);
  return m;
}

TEST(Conductor, KeepsToWhatEveryModelDoes) {
  for (const float alpha : {0.0f, 0.1f, 0.25f, 0.35f, 0.6f, 1.0f})
    check(materialOf(metal(alpha, alpha)), "metal " + std::to_string(alpha));
  check(materialOf(metal(0.5f, 0.5f, false)), "metal without multiple scattering");
}

// Below a coat, both indices are relative to the coat's, however the metal is given.
TEST(Conductor, LiesBelowAnIndex) {
  const ConductorModel m = white(0, false);
  const Scene scene = sceneOf(materialOf(m));
  const SurfacePoint p = seenFrom({0, 0, 1});
  ConductorFresnel half = m.fresnel, indices;
  half.reflectance = Vec3(0.5f);
  indices.eta = Vec3(1);
  indices.k = Vec3(2);  // reflects 0.5 in air
  const MaterialInputs inputs(scene, p);
  for (const float outside : {1.0f, 1.5f}) {
    const FacetFresnel a = metalFresnel(half, outside, inputs),
                       b = metalFresnel(indices, outside, inputs);
    EXPECT_NEAR(a.first.x, b.first.x, 1e-5f);
    EXPECT_NEAR(a.second.x, b.second.x, 1e-5f);
  }
}

TEST(Conductor, AnisotropicKeepsToIt) {
  check(materialOf(metal(0.1f, 0.3f)), "brushed", 0.03f);
  check(materialOf(metal(0.35f, 0.7f)), "rough and brushed", 0.03f);
}

// The Fresnel equations in complex numbers.
float reflectanceOf(double cosine, double eta, double k) {
  const std::complex<double> n(eta, k), sine2(1.0 - cosine * cosine),
      t = std::sqrt(1.0 - sine2 / (n * n));
  const double p = std::norm((n * cosine - t) / (n * cosine + t)),
               s = std::norm((cosine - n * t) / (cosine + n * t));
  return float(0.5 * (p + s));
}

TEST(Conductor, SmoothReflectsByFresnel) {
  ConductorModel m = metal(0, 0);
  m.fresnel.eta = Vec3(0.2f, 0.9f, 2.9f);
  m.fresnel.k = Vec3(3.9f, 2.4f, 3.1f);
  for (const Vec3 wo : views()) {
    const Vec3 leaves = furnace(materialOf(m), wo);
    EXPECT_NEAR(leaves.x, reflectanceOf(double{wo.z}, 0.2, 3.9), 1e-4f);
    EXPECT_NEAR(leaves.y, reflectanceOf(double{wo.z}, 0.9, 2.4), 1e-4f);
    EXPECT_NEAR(leaves.z, reflectanceOf(double{wo.z}, 2.9, 3.1), 1e-4f);
  }
  EXPECT_NEAR(fresnelConductor(1.0f, 0.2f, 3.9f), (0.64f + 15.21f) / (1.44f + 15.21f), 1e-5f);
}

TEST(Conductor, ReflectanceIsThatAtNormalIncidence) {
  ConductorModel m = metal(0, 0);
  m.fresnel.byReflectance = true;
  m.fresnel.reflectance = Vec3(0.9f, 0.5f, 0.1f);
  expectClose(furnace(materialOf(m), {0, 0, 1}), {0.9f, 0.5f, 0.1f}, 1e-3f);
}

// A white metal loses the energy stated in theory.md without multiple scattering, and none with it.
TEST(Conductor, MultipleScatteringReturnsWhatFacetsLose) {
  const Vec3 wo = normalize({0.5f, 0, 1});
  EXPECT_NEAR(1.0f - furnace(materialOf(white(0.5f, false)), wo).x, 0.31f, 0.015f);
  EXPECT_NEAR(1.0f - furnace(materialOf(white(1.0f, false)), wo).x, 0.67f, 0.015f);
  for (const float alpha : {0.2f, 0.5f, 1.0f}) {
    for (const Vec3 w : views())
      EXPECT_NEAR(furnace(materialOf(white(alpha, true)), w).x, 1.0f, 0.01f) << alpha;
  }
}

TEST(Conductor, AlphaSeparatesRoughFromSpecular) {
  for (const float alpha : {0.29f, kRoughAlpha}) {
    const Scene scene = sceneOf(materialOf(metal(0.6f, alpha)));
    const SurfacePoint p = seenFrom({0, 0, 1});
    EXPECT_EQ(Bsdf(scene, p).hasRough(), alpha >= kRoughAlpha);
    EXPECT_EQ(Bsdf(scene, p).specularProbability(), alpha >= kRoughAlpha ? 0.0f : 1.0f);
  }
  const Scene smooth = sceneOf(materialOf(metal(0, 0)));
  const SurfacePoint p = seenFrom({0, 0, 1});
  EXPECT_TRUE(Bsdf(smooth, p).specularIsDelta());
  EXPECT_TRUE(hasSpecularLobes(smooth));
}

// Scratches along x scatter light along y.
TEST(Conductor, AnisotropyFollowsTheTangent) {
  const Scene scene = sceneOf(materialOf(metal(0.05f, 0.6f)));
  SurfacePoint p = seenFrom({0, 0, 1});
  const Vec3 alongX = normalize({0.5f, 0, 1}), alongY = normalize({0, 0.5f, 1});
  const auto value = [&](Vec3 wi) { return Bsdf(scene, p).eval(LobeGroup::Specular, wi).x; };
  EXPECT_GT(value(alongY), 10.0f * value(alongX));
  p.tangent = {0, 2, 0};
  EXPECT_GT(value(alongX), 10.0f * value(alongY));
}

}  // namespace
}  // namespace bnvpl::test
