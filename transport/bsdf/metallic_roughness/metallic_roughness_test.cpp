// glTF's material against the formulas of appendix B of its specification.
#include "transport/bsdf/metallic_roughness/metallic_roughness.h"

#include "tests/support/bsdf_checks.h"
#include "transport/direct_light/direct_light.h"

namespace bnvpl::test {
namespace {

MetallicRoughnessModel gltf(float metallic, float roughness, Vec3 base = {0.9f, 0.5f, 0.1f}) {
  MetallicRoughnessModel m;
  m.baseColour = base;
  m.metallic = metallic;
  m.roughness = roughness;
  return m;
}

TEST(MetallicRoughness, KeepsToWhatEveryModelDoes) {
  for (const float metallic : {0.0f, 0.4f, 1.0f})
    for (const float roughness : {0.0f, 0.35f, 0.6f, 1.0f})
      check(materialOf(gltf(metallic, roughness)),
            "metal " + std::to_string(metallic) + " rough " + std::to_string(roughness), 0.02f);
}

TEST(MetallicRoughness, ExtensionsKeepToIt) {
  MetallicRoughnessModel coated = gltf(0.3f, 0.7f, Vec3(1));
  coated.clearcoat = 1.0f;
  coated.clearcoatRoughness = 0.3f;
  check(materialOf(coated), "clearcoat", 0.03f);
  for (const float roughness : {0.0f, 0.3f, 0.8f}) {
    MetallicRoughnessModel wall = gltf(0.0f, roughness, Vec3(1));
    wall.transmission = 0.7f;
    check(materialOf(wall), "thin wall " + std::to_string(roughness), 0.02f);
  }
  MetallicRoughnessModel specular = gltf(0.0f, 0.5f);
  specular.specular = 0.5f;
  specular.specularColour = Vec3(1, 0.5f, 0.2f);
  specular.ior = 1.8f;
  check(materialOf(specular), "specular", 0.02f);
}

// Path reuse shares light by the diffuse part: it must not depend on wo, and the rest should be
// little but gloss.
TEST(MetallicRoughness, DiffusePartIsTheSameFromEverywhereAndNearTheBase) {
  const Scene scene = sceneOf(materialOf(gltf(0.4f, 0.8f)));
  const Vec3 wi = normalize({-0.3f, 0.2f, 1});
  Vec3 first;
  for (const Vec3 wo : {Vec3{0, 0, 1}, normalize({0.5f, 0.1f, 1}), normalize({-2, 1, 1})}) {
    const SurfacePoint p = seenFrom(wo);
    const Bsdf bsdf(scene, p);
    const DiffusePart part = bsdf.diffusePart();
    if (isBlack(first)) first = part.value;
    EXPECT_EQ(part.value, first);
    EXPECT_EQ(part.leaving.towards(wo), 1.0f);
    const Vec3 all = bsdf.eval(LobeGroup::Rough, wi) * (1.0f / diffuseCosine(p, wi));
    for (int c = 0; c < 3; ++c) EXPECT_LT(part.value[c], 1.2f * all[c]) << c;
  }
  EXPECT_GT(first.x, 0.5f * 0.6f * 0.9f / kPi);
  const Scene metal = sceneOf(materialOf(gltf(1.0f, 0.8f)));
  const SurfacePoint p = seenFrom({0, 0, 1});
  EXPECT_TRUE(isBlack(Bsdf(metal, p).diffusePart().value));
}

// The formulas of appendix B.3.5 in its own notation.
Vec3 appendixB(Vec3 base, float metallic, float roughness, Vec3 l, Vec3 v) {
  const Vec3 h = normalize(l + v), black;
  const float alpha = roughness * roughness, a2 = alpha * alpha;
  const auto mix = [](Vec3 a, Vec3 b, float t) { return a * (1 - t) + b * t; };
  const Vec3 cDiff = mix(base, black, metallic), f0 = mix(Vec3(0.04f), base, metallic);
  const Vec3 f = f0 + (Vec3(1) - f0) * std::pow(1 - std::fabs(dot(v, h)), 5.0f);
  const float d = a2 / (kPi * std::pow(h.z * h.z * (a2 - 1) + 1, 2.0f));
  const float visibility = 0.5f / (l.z * std::sqrt(v.z * v.z * (1 - a2) + a2) +
                                   v.z * std::sqrt(l.z * l.z * (1 - a2) + a2));
  return (Vec3(1) - f) * (1 / kPi) * cDiff + f * (visibility * d);
}

TEST(MetallicRoughness, IsAppendixB) {
  const Vec3 base{0.9f, 0.5f, 0.1f}, wi = normalize({-0.3f, 0.2f, 1});
  for (const float metallic : {0.0f, 0.5f, 1.0f}) {
    for (const float roughness : {0.6f, 0.8f, 1.0f}) {
      const Scene scene = sceneOf(materialOf(gltf(metallic, roughness)));
      const Vec3 wo = normalize({0.3f, 0.4f, 1});
      const SurfacePoint p = seenFrom(wo);
      const Bsdf bsdf(scene, p);
      const Vec3 value =
          (bsdf.eval(LobeGroup::Rough, wi) + bsdf.eval(LobeGroup::Specular, wi)) / wi.z;
      // For metallic 0.5 the appendix is ambiguous: it mixes two materials, or their parameters.
      const Vec3 expected = metallic == 0.5f ? 0.5f * (appendixB(base, 0, roughness, wi, wo) +
                                                       appendixB(base, 1, roughness, wi, wo))
                                             : appendixB(base, metallic, roughness, wi, wo);
      expectClose(value, expected, 0.02f,
                  std::to_string(metallic) + " " + std::to_string(roughness));
    }
  }
}

// The base of a VPL's material reflects its albedo (theory.md, eq. 4).
TEST(MetallicRoughness, BaseReflectsItsAlbedo) {
  for (const float ior : {1.2f, 1.5f, 2.5f})
    for (const float specular : {0.0f, 0.3f, 1.0f})
      for (const float roughness : {0.0f, 0.2f, 0.7f, 0.95f})
        for (const Vec3 wo : {views()[0], views()[1], views()[2], normalize({1, 0, 0.03f})}) {
          const float normal = (ior - 1.0f) / (ior + 1.0f);
          const LayeredBase base{Vec3(1), normal * normal * specular, specular,
                                 roughness * roughness, false};
          double sum = 0.0;
          constexpr int kSide = 64;
          for (int i = 0; i < kSide * kSide; ++i) {
            const Vec3 wi = sampleCosineHemisphere((float(i % kSide) + 0.5f) / kSide,
                                                   (float(i / kSide) + 0.5f) / kSide);
            sum += double{base.value(wo, wi, TransportMode::Radiance).x} * double{kPi};
          }
          EXPECT_NEAR(base.albedo(wo).x, sum / (kSide * kSide), 0.01)
              << ior << " " << specular << " " << roughness << " from " << wo.z;
        }
}

// A VPL sends on what the rough lobes reflect below a coat, which keeps more of what leaves at
// grazing angles.
TEST(MetallicRoughness, CoatedBaseReflectsItsAlbedo) {
  for (const float metallic : {0.0f, 0.5f, 1.0f})
    for (const float roughness : {0.0f, 0.3f, 0.6f, 0.8f, 1.0f})
      for (const float coatRoughness : {0.0f, 0.3f, 0.5f}) {
        MetallicRoughnessModel m = gltf(metallic, roughness);
        m.clearcoat = 1.0f;
        m.clearcoatRoughness = coatRoughness;
        const Scene scene = sceneOf(materialOf(m));
        for (const Vec3 wo : views()) {
          const SurfacePoint p = seenFrom(wo);
          const Bsdf bsdf(scene, p);
          const float leaves = mean(meanWeight(bsdf, LobeGroup::Rough));
          EXPECT_NEAR(mean(bsdf.exactRoughAlbedo()), leaves,
                      leaves * (metallic > 0.0f ? 0.012f : 0.007f))
              << metallic << " " << roughness << " below " << coatRoughness << " from " << wo.z;
        }
      }
}

// prepareFor() makes lobes faster and changes no bit, for the prepared direction or for another
// one.
template <typename Lobe>
void expectSamePrepared(const Lobe& lobe) {
  for (const Vec3 prepared : views())
    for (const Vec3 wo : views()) {
      Lobe kept = lobe;
      kept.prepareFor(prepared);
      const Vec3 wi = normalize({0.3f, -0.5f, 0.6f});
      EXPECT_EQ(kept.value(wo, wi, TransportMode::Radiance),
                lobe.value(wo, wi, TransportMode::Radiance));
      EXPECT_EQ(kept.bound(wo, 0.7f, 1.0f), lobe.bound(wo, 0.7f, 1.0f));
    }
}

TEST(MetallicRoughness, PreparedLobesHaveTheSameValues) {
  expectSamePrepared(LayeredBase{Vec3(0.8f), 0.04f, 1.0f, 0.3f, false});
  expectSamePrepared(CoatedBase{Vec3(0.2f), {0.3f, 1.5f}, 0.2f});
}

// At grazing angles the appendix reflects more than arrives. Here the energy is preserved
// (theory.md, eq. 3).
TEST(MetallicRoughness, WhiteStaysBelowWhatArrives) {
  for (const float roughness : {0.1f, 0.5f, 1.0f}) {
    for (const Vec3 wo : {views()[0], views()[1], views()[2], normalize({1, 0, 0.05f})}) {
      const float leaves = furnace(materialOf(gltf(0, roughness, Vec3(1))), wo).x;
      EXPECT_LE(leaves, 1.003f) << roughness << " " << wo.z;
      EXPECT_GE(leaves, 0.9f) << roughness << " " << wo.z;
    }
  }
}

TEST(MetallicRoughness, ExtensionsSetTheReflectance) {
  const auto normal = [](const MetallicRoughnessModel& m) {
    const Scene scene = sceneOf(materialOf(m));
    const SurfacePoint p = seenFrom({0, 0, 1});
    return meanWeight(Bsdf(scene, p), LobeGroup::Specular);
  };
  MetallicRoughnessModel m = gltf(0, 0, Vec3(0.5f));
  expectClose(normal(m), Vec3(0.04f), 1e-3f);
  m.ior = 2.0f;
  expectClose(normal(m), Vec3(1.0f / 9), 1e-3f);
  m.specularColour = Vec3(0.5f, 1, 20);
  expectClose(normal(m), {0.5f / 9, 1.0f / 9, 1}, 1e-3f);
  m.specular = 0.5f;
  expectClose(normal(m), {0.25f / 9, 0.5f / 9, 0.5f}, 1e-3f);
  m = gltf(0, 1, Vec3(0.5f));
  m.clearcoat = 0.5f;
  expectClose(normal(m), Vec3(0.02f), 1e-3f);
}

TEST(MetallicRoughness, ThinWallLetsStraightThrough) {
  MetallicRoughnessModel m = gltf(0, 0, {0.5f, 0.6f, 0.7f});
  m.transmission = 1.0f;
  const Scene scene = sceneOf(materialOf(m));
  const SurfacePoint p = seenFrom(views()[1]);
  BsdfSample s;
  ASSERT_TRUE(
      Bsdf(scene, p).sample(LobeGroup::Specular, TransportMode::Radiance, 0.999f, {0.2f, 0.3f}, s));
  EXPECT_LT(length(s.wi + p.wo), 1e-4f);
  EXPECT_FALSE(Bsdf(scene, p).hasRough());
}

// A clearcoat mirrors about its own normal instead of the base's, and energy is preserved.
TEST(MetallicRoughness, CoatReflectsAboutItsOwnNormal) {
  MetallicRoughnessModel m = gltf(0, 1, Vec3(0.5f));
  m.clearcoat = 1.0f;
  const Scene scene = sceneOf(materialOf(m));
  SurfacePoint p = seenFrom(views()[1], normalize({0.3f, 0, 1}));
  BsdfSample s;
  const auto mirrored = [&] {
    EXPECT_TRUE(
        Bsdf(scene, p).sample(LobeGroup::Specular, TransportMode::Radiance, 0.5f, {0.2f, 0.3f}, s));
    return s.wi;
  };
  EXPECT_LT(length(mirrored() - reflect(p.wo, p.ns)), 1e-4f);
  for (const Vec3 coat : {Vec3{0, 0, 1}, normalize({-0.2f, 0.1f, 1})}) {
    p.coat = coat;
    EXPECT_LT(length(mirrored() - reflect(p.wo, coat)), 1e-4f);
  }
}

TEST(MetallicRoughness, CoatWithItsOwnNormalKeepsToWhatEveryModelDoes) {
  for (const float roughness : {0.3f, 0.7f}) {  // the second belongs to the rough group
    MetallicRoughnessModel m = gltf(0.3f, 0.7f, Vec3(1));
    m.clearcoat = 1.0f;
    m.clearcoatRoughness = roughness;
    const Scene scene = sceneOf(materialOf(m));
    for (size_t k = 0; k < 2 * views().size(); ++k) {
      const Vec3 wo = views()[k / 2];
      SurfacePoint p = seenFrom(wo, normalize({0.1f, 0.1f, 1}));
      p.coat = k % 2 == 0 ? normalize({-0.1f, 0.05f, 1}) : Vec3(0, 0, 1);
      const Bsdf bsdf(scene, p);
      Vec3 sum;
      for (const LobeGroup group : kGroups) {
        checkDensity(bsdf, group, "coat");
        sum += meanWeight(bsdf, group);
        forEachSample(bsdf, group, TransportMode::Radiance, 400, [&](const BsdfSample& s) {
          expectClose(s.weight * s.pdf, bsdf.eval(group, s.wi), 2e-3f, "coat");
        });
        forEachSample(bsdf, group, TransportMode::Importance, 400, [&](const BsdfSample& s) {
          if (std::fabs(s.wi.z) < 0.15f || dot(s.wi, p.ns) < 0.15f || dot(s.wi, p.coat) < 0.15f)
            return;
          SurfacePoint there = seenFrom(s.wi, p.ns);
          there.coat = p.coat;
          expectClose(s.weight * s.pdf * (wo.z / s.wi.z), Bsdf(scene, there).eval(group, wo), 5e-3f,
                      "coat adjoint");
        });
      }
      checkBound(bsdf, "coat");
      EXPECT_LE(maxComponent(sum), 1.04f);
    }
  }
}

// An eighth of a turn, seen from either side, is the tangent rotated about the outward normal.
TEST(MetallicRoughness, ScratchesTurn) {
  MetallicRoughnessModel straight = gltf(1, 0.6f), turned = straight;
  straight.anisotropy = turned.anisotropy = 0.8f;
  turned.anisotropyTurns = 0.125f;
  const Scene a = sceneOf(materialOf(straight)), b = sceneOf(materialOf(turned));
  for (const float side : {1.0f, -1.0f}) {
    SurfacePoint p = seenFrom(normalize({1, 0.4f, side})), along = p;
    along.tangent = {1, 1, 0};
    checkDensity(Bsdf(b, p), LobeGroup::Specular, "turned");
    float most = 0.0f;
    for (float phi = 0.0f; phi < 6.0f; phi += 0.5f) {
      const Vec3 wi = normalize({std::cos(phi), std::sin(phi), side});
      const Vec3 value = Bsdf(b, p).eval(LobeGroup::Specular, wi);
      expectClose(value, Bsdf(a, along).eval(LobeGroup::Specular, wi), 1e-3f, "turned");
      most = std::max(most, length(value - Bsdf(a, p).eval(LobeGroup::Specular, wi)));
    }
    EXPECT_GT(most, 0.05f);
  }
}

}  // namespace
}  // namespace bnvpl::test
