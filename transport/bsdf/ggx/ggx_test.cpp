// The distribution of microfacets: its integrals, its samples, its tables.
#include "transport/bsdf/ggx/ggx.h"

#include "tests/support/bsdf_checks.h"
#include "transport/bsdf/fresnel.h"
#include "transport/bsdf/ggx/albedo_table.h"

namespace bnvpl::test {
namespace {

constexpr Ggx kShapes[] = {{0.1f, 0.1f}, {0.3f, 0.3f}, {1.0f, 1.0f}, {0.1f, 0.4f}, {0.8f, 0.3f}};

double overHemisphere(const std::function<double(Vec3)>& fn) {
  constexpr int kRows = 600, kColumns = 240;
  double sum = 0.0;
  for (int i = 0; i < kRows; ++i) {
    const double theta = 0.5 * double{kPi} * (i + 0.5) / kRows, r = std::sin(theta);
    for (int j = 0; j < kColumns; ++j) {
      const double phi = 2.0 * double{kPi} * (j + 0.5) / kColumns;
      sum += r * fn({float(r * std::cos(phi)), float(r * std::sin(phi)), float(std::cos(theta))});
    }
  }
  return sum * double{kPi} * double{kPi} / (double(kRows) * kColumns);
}

// The facets' projected area is that of the surface, seen from above (D) and from aside (G1 D):
// Heitz 2014, equations 4 and 16.
TEST(Ggx, FacetsCoverTheSurface) {
  for (const Ggx& g : kShapes) {
    EXPECT_NEAR(overHemisphere([&](Vec3 h) { return double{g.density(h) * h.z}; }), 1.0, 2e-3);
    for (const Vec3 wo : views())
      EXPECT_NEAR(overHemisphere([&](Vec3 h) { return double{g.visibleDensity(wo, h)}; }), 1.0,
                  2e-3);
  }
}

TEST(Ggx, SamplesFollowTheVisibleFacets) {
  for (const Ggx& g : kShapes) {
    for (const Vec3 wo : views()) {
      SphereCells cells;
      constexpr int kCount = 60000;
      for (int i = 0; i < kCount; ++i) {
        Rng rng(7, uint64_t(i));
        const float u = rng.next(), v = rng.next();
        cells.draw(g.sampleVisible(wo, {u, v}));
      }
      cells.integrate([&](Vec3 h) { return h.z > 0.0f ? g.visibleDensity(wo, h) : 0.0f; }, kCount);
      EXPECT_LT(cells.deviate(), 4.5) << g.alongX << " " << wo.z;
    }
  }
}

// Of facets that reflect all, by brute force: sum over directions that leave.
TEST(Ggx, TablesHoldTheAlbedo) {
  for (const float alpha : {0.15f, 0.4f, 0.9f}) {
    const Ggx g{alpha, alpha};
    for (const Vec3 wo : views()) {
      const auto albedo = [&](const std::function<float(float)>& fresnel) {
        return float(overHemisphere([&](Vec3 wi) {
          const Vec3 h = normalize(wo + wi);
          return double{g.reflected(wo, wi, h) * wi.z * fresnel(dot(wo, h))};
        }));
      };
      EXPECT_NEAR(ggxLoss(wo.z, alpha), 1.0f - albedo([](float) { return 1.0f; }), 0.005f);
      EXPECT_NEAR(dielectricAlbedo(wo.z, alpha, 1.5f),
                  albedo([](float c) { return fresnelDielectric(c, 1.5f); }), 0.004f);
      EXPECT_NEAR(dielectricAlbedo(wo.z, alpha, 1.33f),
                  albedo([](float c) { return fresnelDielectric(c, 1.33f); }), 0.004f);
      const Vec3 eta(0.2f), k(3.9f);
      EXPECT_NEAR(ggxAlbedo(schlickOf(eta, k), wo.z, alpha).x,
                  albedo([&](float c) { return fresnelConductor(c, 0.2f, 3.9f); }), 0.005f);
    }
  }
}

TEST(Ggx, SmoothTablesAreTheFresnelEquations) {
  for (const float c : {0.1f, 0.5f, 1.0f}) {
    EXPECT_FLOAT_EQ(dielectricAlbedo(c, 0.0f, 1.5f), fresnelDielectric(c, 1.5f));
    EXPECT_NEAR(ggxLoss(c, 0.0f), 0.0f, 2e-3f);
  }
  // 1 - T of diffuse light into glass of index 1.5: 0.0918 (Walsh 1926).
  EXPECT_NEAR(dielectricMeanAlbedo(0.0f, 1.5f), 0.0918f, 1e-3f);
}

}  // namespace
}  // namespace bnvpl::test
