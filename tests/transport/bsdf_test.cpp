// Lambert, Phong and mirror: energy, reciprocity, and consistency of sample(), pdf() and eval().
#include "transport/bsdf.h"

#include "tests/transport/plain_scene.h"

namespace bnvpl {
namespace {

Material phong(Vec3 kd, Vec3 ks, float exponent) {
  Material m = lambert(kd);
  m.phong().glossy = ks;
  m.phong().exponent = exponent;
  return m;
}
Material mirror(Vec3 ks, Vec3 kd = {}) {
  Material m = lambert(kd);
  m.phong().mirror = ks;
  return m;
}

struct Case {
  const char* name;
  Material material;
};
const std::vector<Case>& materials() {
  static const std::vector<Case> all{
      {"lambert", lambert({0.8f, 0.5f, 0.1f})},
      {"rough phong", phong({}, {0.6f, 0.5f, 0.4f}, 4)},
      {"lambert + rough phong", phong({0.5f, 0.3f, 0.1f}, {0.2f, 0.3f, 0.4f}, 12)},
      {"lambert + sharp phong", phong({0.4f, 0.3f, 0.2f}, {0.3f, 0.4f, 0.5f}, 150)},
      {"sharp phong", phong({}, {0.9f, 0.8f, 0.7f}, 60)},
      {"lambert + mirror", mirror({0.3f, 0.3f, 0.2f}, {0.5f, 0.2f, 0.1f})},
      {"too much of everything", phong({0.9f, 0.8f, 0.1f}, {0.7f, 0.9f, 0.3f}, 8)},
  };
  return all;
}
const std::vector<Vec3>& views() {
  static const std::vector<Vec3> all{
      {0, 0, 1}, normalize({1, 0.4f, 1}), normalize({-1, 0.2f, 0.2f})};
  return all;
}
constexpr LobeGroup kGroups[] = {LobeGroup::Rough, LobeGroup::Specular};

// Integrates f over the hemisphere about +z by the midpoint rule in (cosine, azimuth).
Vec3 overHemisphere(const std::function<Vec3(Vec3)>& f) {
  constexpr int kRows = 400, kColumns = 800;
  double sum[3] = {0, 0, 0};
  for (int i = 0; i < kRows; ++i) {
    const double z = (i + 0.5) / kRows, r = std::sqrt(1.0 - z * z);
    for (int j = 0; j < kColumns; ++j) {
      const double phi = 2.0 * double{kPi} * (j + 0.5) / kColumns;
      const Vec3 v = f({float(r * std::cos(phi)), float(r * std::sin(phi)), float(z)});
      for (size_t c = 0; c < 3; ++c) sum[c] += double{v[c]};
    }
  }
  const double cell = 2.0 * double{kPi} / (double{kRows} * kColumns);
  return {float(sum[0] * cell), float(sum[1] * cell), float(sum[2] * cell)};
}

Vec3 meanWeight(const Bsdf& bsdf, LobeGroup group, TransportMode transport, int count = 200000) {
  return meanOver(count, [&](Rng& rng) {
    BsdfSample s;
    return bsdf.sample(group, transport, rng, s) ? s.weight : Vec3{};
  });
}

bool isDelta(const Bsdf& bsdf, LobeGroup group) {
  return group == LobeGroup::Specular && bsdf.specularIsDelta();
}

TEST(Bsdf, LambertReflectsItsAlbedoFromEverywhere) {
  const Scene scene = sceneOf(lambert({0.8f, 0.5f, 0.1f}));
  for (const Vec3 wo : views()) {
    const SurfacePoint p = pointSeenFrom(wo);
    const Bsdf bsdf(scene, p);
    expectClose(overHemisphere([&](Vec3 wi) { return bsdf.eval(LobeGroup::Rough, wi); }),
                {0.8f, 0.5f, 0.1f}, 1e-3f);
    expectClose(meanWeight(bsdf, LobeGroup::Rough, TransportMode::Radiance, 1000),
                {0.8f, 0.5f, 0.1f}, 1e-4f);
    EXPECT_EQ(bsdf.specularProbability(), 0.0f);
    EXPECT_FLOAT_EQ(bsdf.survivalProbability(), 0.8f);
    EXPECT_EQ(bsdf.eval(LobeGroup::Rough, {0, 0, -1}), Vec3());
  }
}

TEST(Bsdf, NeverReflectsMoreThanArrives) {
  for (const Case& c : materials()) {
    const Scene scene = sceneOf(c.material);
    for (const Vec3 wo : views()) {
      const SurfacePoint p = pointSeenFrom(wo);
      const Bsdf bsdf(scene, p);
      Vec3 sum;
      for (const LobeGroup group : kGroups)
        sum += meanWeight(bsdf, group, TransportMode::Radiance, 50000);
      const Material& m = c.material;
      const Vec3 most = min(m.phong().diffuse + m.phong().glossy + m.phong().mirror, Vec3(1));
      for (size_t k = 0; k < 3; ++k)
        EXPECT_LE(sum[k], most[k] * 1.01f) << c.name << " from z = " << wo.z;
      EXPECT_LE(maxComponent(bsdf.roughAlbedo()), 1.0f) << c.name;
      EXPECT_LE(bsdf.survivalProbability(), 1.0f) << c.name;
      EXPECT_GE(bsdf.survivalProbability(), maxComponent(sum) * 0.99f)
          << c.name;  // else Russian roulette would brighten
    }
  }
}

TEST(Bsdf, SampledWeightsMeanTheIntegral) {
  for (const Case& c : materials()) {
    const Scene scene = sceneOf(c.material);
    for (const Vec3 wo : views()) {
      const SurfacePoint p = pointSeenFrom(wo);
      const Bsdf bsdf(scene, p);
      for (const LobeGroup group : kGroups) {
        if (isDelta(bsdf, group)) continue;
        const Vec3 integral = overHemisphere([&](Vec3 wi) { return bsdf.eval(group, wi); });
        expectClose(meanWeight(bsdf, group, TransportMode::Radiance), integral, 0.01f,
                    std::string(c.name) + " from z = " + std::to_string(wo.z));
      }
    }
  }
}

// Above the surface, the density integrates to the share of samples that are not lost below it.
TEST(Bsdf, DensityHoldsTheShareOfSamplesThatLeave) {
  for (const Case& c : materials()) {
    const Scene scene = sceneOf(c.material);
    for (const Vec3 wo : views()) {
      const SurfacePoint p = pointSeenFrom(wo);
      const Bsdf bsdf(scene, p);
      for (const LobeGroup group : kGroups) {
        if (isDelta(bsdf, group) || (group == LobeGroup::Rough && !bsdf.hasRough())) continue;
        const float leaving =
            meanOver(100000, [&](Rng& rng) {
              BsdfSample s;
              return Vec3(bsdf.sample(group, TransportMode::Radiance, rng, s) ? 1.0f : 0.0f);
            }).x;
        const float integral = overHemisphere([&](Vec3 wi) { return Vec3(bsdf.pdf(group, wi)); }).x;
        EXPECT_NEAR(integral, leaving, 0.01f) << c.name << " from z = " << wo.z;
        EXPECT_LE(integral, 1.01f) << c.name;
      }
    }
  }
}

TEST(Bsdf, SampleNamesItsOwnDensityAndValue) {
  for (const Case& c : materials()) {
    const Scene scene = sceneOf(c.material);
    for (const Vec3 wo : views()) {
      const SurfacePoint p = pointSeenFrom(wo);
      const Bsdf bsdf(scene, p);
      for (const LobeGroup group : kGroups) {
        if (isDelta(bsdf, group)) continue;
        for (uint64_t i = 0; i < 200; ++i) {
          Rng rng(3, i);
          BsdfSample s;
          if (!bsdf.sample(group, TransportMode::Radiance, rng, s)) continue;
          ASSERT_NEAR(length(s.wi), 1.0f, 1e-5f);
          ASSERT_NEAR(s.pdf, bsdf.pdf(group, s.wi), 1e-4f * s.pdf + 1e-6f) << c.name;
          expectClose(s.weight * s.pdf, bsdf.eval(group, s.wi), 1e-4f, c.name);
          ASSERT_EQ(s.side, Vec3(0, 0, 1));
        }
      }
    }
  }
}

TEST(Bsdf, IsReciprocal) {
  for (const Case& c : materials()) {
    const Scene scene = sceneOf(c.material);
    Rng rng(9, 1);
    for (int i = 0; i < 500; ++i) {
      const float u = rng.next(), v = rng.next(), s = rng.next(), t = rng.next();
      const Vec3 a = sampleCosineHemisphere(u, v), b = sampleCosineHemisphere(s, t);
      if (a.z < 0.02f || b.z < 0.02f) continue;
      const SurfacePoint fromA = pointSeenFrom(a), fromB = pointSeenFrom(b);
      for (const LobeGroup group : kGroups) {
        expectClose(Bsdf(scene, fromA).eval(group, b) / b.z,
                    Bsdf(scene, fromB).eval(group, a) / a.z, 2e-3f, c.name);
      }
    }
  }
}

TEST(Bsdf, PhotonsAndRadianceReflectAlikeOnFlatNormals) {
  for (const Case& c : materials()) {
    const Scene scene = sceneOf(c.material);
    for (const Vec3 wo : views()) {
      const SurfacePoint p = pointSeenFrom(wo);
      const Bsdf bsdf(scene, p);
      EXPECT_FLOAT_EQ(bsdf.photonShadingFactor(), 1.0f);
      for (const LobeGroup group : kGroups) {
        expectClose(meanWeight(bsdf, group, TransportMode::Importance),
                    meanWeight(bsdf, group, TransportMode::Radiance), 0.01f, c.name);
      }
    }
  }
}

// With a shading normal, photons are scaled by the ratio of cosines on the incident side and leave
// by the geometric cosine (Veach 1997, section 5.3).
TEST(Bsdf, ShadingNormalsScalePhotons) {
  const Scene scene = sceneOf(lambert(Vec3(0.6f)));
  const SurfacePoint p = pointSeenFrom({0.6f, 0, 0.8f}, {0, 0, 1}, {0.3f, 0, 1});
  const Bsdf bsdf(scene, p);
  const float factor = dot(p.ns, p.wo) / dot(p.ng, p.wo);
  EXPECT_GT(factor, 1.1f);
  EXPECT_FLOAT_EQ(bsdf.photonShadingFactor(), factor);
  expectClose(meanWeight(bsdf, LobeGroup::Rough, TransportMode::Importance), Vec3(0.6f * factor),
              1e-3f);
  const Vec3 integral = overHemisphere([&](Vec3 wi) { return bsdf.eval(LobeGroup::Rough, wi); });
  expectClose(meanWeight(bsdf, LobeGroup::Rough, TransportMode::Radiance), integral, 0.01f);
}

TEST(Bsdf, MirrorReturnsTheOneDirection) {
  const Scene scene = sceneOf(mirror({0.9f, 0.8f, 0.7f}));
  EXPECT_TRUE(hasSpecularLobes(scene));
  for (const Vec3 wo : views()) {
    const SurfacePoint p = pointSeenFrom(wo);
    const Bsdf bsdf(scene, p);
    EXPECT_EQ(bsdf.specularProbability(), 1.0f);
    EXPECT_FALSE(bsdf.hasRough());
    EXPECT_TRUE(bsdf.specularIsDelta());
    for (const TransportMode transport : {TransportMode::Radiance, TransportMode::Importance}) {
      Rng rng(1, 2);
      BsdfSample s;
      ASSERT_TRUE(bsdf.sample(LobeGroup::Specular, transport, rng, s));
      EXPECT_LT(length(s.wi - Vec3(-wo.x, -wo.y, wo.z)), 1e-5f);
      expectClose(s.weight, {0.9f, 0.8f, 0.7f}, 1e-5f);
      EXPECT_EQ(s.pdf, 0.0f);
    }
    EXPECT_EQ(bsdf.eval(LobeGroup::Specular, {-wo.x, -wo.y, wo.z}), Vec3());
  }
}

TEST(Bsdf, ExponentSeparatesRoughFromSpecular) {
  for (const float exponent : {kNearSpecularExponent, kNearSpecularExponent + 1.0f}) {
    const Scene scene = sceneOf(phong(Vec3(0.2f), Vec3(0.5f), exponent));
    const SurfacePoint p = pointSeenFrom({0, 0, 1});
    const bool sharp = exponent > kNearSpecularExponent;
    EXPECT_EQ(hasSpecularLobes(scene), sharp);
    EXPECT_FLOAT_EQ(Bsdf(scene, p).roughAlbedo().x, sharp ? 0.2f : 0.7f);
    EXPECT_EQ(Bsdf(scene, p).specularProbability() > 0.0f, sharp);
  }
}

TEST(Bsdf, UpperBoundHolds) {
  for (const Case& c : materials()) {
    const Scene scene = sceneOf(c.material);
    const SurfacePoint p = pointSeenFrom({0.5f, 0.2f, 0.6f});
    const Bsdf bsdf(scene, p);
    Rng rng(5, 5);
    for (int i = 0; i < 300; ++i) {
      const float u = rng.next(), v = rng.next();
      const Vec3 wi = sampleCosineHemisphere(u, v);
      const Vec3 bound = bsdf.roughUpperBound(wi.z, [&](Vec3 axis) { return dot(axis, wi); });
      const Vec3 value = bsdf.eval(LobeGroup::Rough, wi);
      for (size_t k = 0; k < 3; ++k) ASSERT_LE(value[k], bound[k] * 1.0001f + 1e-6f) << c.name;
    }
  }
}

}  // namespace
}  // namespace bnvpl
