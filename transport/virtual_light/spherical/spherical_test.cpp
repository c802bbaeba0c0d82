// Light of spherical VPLs: closed form, samples and limits.
#include "tests/transport/plain_scene.h"
#include "transport/virtual_light/spherical/spherical_transfer.h"

namespace bnvpl {
namespace {

constexpr unsigned kMany = 1 << 14;

// A receiver at the origin that faces +z.
struct Receiver {
  explicit Receiver(const Material& material, Vec3 wo = {0.3f, 0.2f, 1.0f})
      : scene(sceneOf(material)), point(pointSeenFrom(wo)), bsdf(scene, point) {}
  Scene scene;
  SurfacePoint point;
  Bsdf bsdf;
};

Material glossy() {
  Material m;
  ConductorModel metal;
  metal.roughness = Roughness(Scalar(0.3f), Roughness::Alpha::Same);
  m.model = metal;
  return m;
}

// Midpoint rule over the whole sphere of directions, in rings about its axis.
Vec3 integral(const VirtualSphericalLight& vpl, const Bsdf& bsdf) {
  constexpr int kRows = 200, kColumns = 400;
  const float d2 = lengthSquared(vpl.toCentre);
  const bool inside = d2 <= vpl.radius2;
  const double cosine = inside ? 0.0 : std::sqrt(1.0 - double{vpl.radius2} / double{d2});
  const Frame basis(inside ? bsdf.point().ns : normalize(vpl.toCentre));
  double sum[3] = {0, 0, 0};
  for (int i = 0; i < kRows; ++i) {
    const double z = cosine + (1.0 - cosine) * (i + 0.5) / kRows, r = std::sqrt(1.0 - z * z);
    for (int j = 0; j < kColumns; ++j) {
      const double phi = 2.0 * double{kPi} * (j + 0.5) / kColumns;
      const Vec3 w = basis.toWorld({float(r * std::cos(phi)), float(r * std::sin(phi)), float(z)});
      const float emitted = std::max(0.0f, -dot(vpl.normal, w));
      const Vec3 light = bsdf.eval(LobeGroup::Rough, w) * emitted;
      for (size_t c = 0; c < 3; ++c) sum[c] += double{light[c]};
    }
  }
  const double scale = 2.0 * (1.0 - cosine) / double{vpl.radius2} / kRows / kColumns;
  return {float(sum[0] * scale), float(sum[1] * scale), float(sum[2] * scale)};
}

// Near and far, tilted both ways, cut by either horizon, and around the receiver.
std::vector<VirtualSphericalLight> vpls() {
  std::vector<VirtualSphericalLight> all;
  for (const Vec3 at : {Vec3{0.1f, 0.2f, 1.0f}, Vec3{0.5f, -0.3f, 0.6f}, Vec3{0.9f, 0.1f, 0.2f}}) {
    for (const Vec3 normal : {Vec3{0, 0, -1}, Vec3{-0.8f, 0.1f, -0.3f}, Vec3{-0.3f, 0.9f, 0.2f}}) {
      for (const float radius : {0.05f, 0.4f, 0.7f, 2.0f})
        all.push_back({at, normalize(normal), radius * radius});
    }
  }
  return all;
}

TEST(SphericalLight, OfDiffuseSurfacesIsTheIntegral) {
  const Receiver floor(lambert({0.8f, 0.5f, 0.1f}));
  for (const VirtualSphericalLight& vpl : vpls()) {
    const Vec3 expected = integral(vpl, floor.bsdf);
    const float scale = 2e-3f * floor.bsdf.diffuseValue().x / lengthSquared(vpl.toCentre);
    const Vec3 sampled = sampledSphericalTransfer(vpl, floor.bsdf, kMany, 1);
    // What a horizon cuts has few samples: its mean over keys counts.
    double mean = 0.0;
    for (uint64_t key = 0; key < 1000; ++key)
      mean += double{sphericalTransfer(vpl, floor.bsdf, key).value.x} / 1000;
    EXPECT_NEAR(sampled.x, expected.x, scale);
    EXPECT_NEAR(mean, expected.x, 4.0f * scale);
  }
}

// Without a horizon there is no noise: the closed form is the same for every key.
TEST(SphericalLight, IsClosedWhereNoHorizonCutsIt) {
  const Receiver floor(lambert(Vec3(0.5f)));
  const auto differs = [&](const VirtualSphericalLight& vpl) {
    const SphericalLightTransfer one = sphericalTransfer(vpl, floor.bsdf, 1);
    EXPECT_EQ(one.sampled, one.value.x != sphericalTransfer(vpl, floor.bsdf, 2).value.x);
    return one.sampled;
  };
  const Vec3 down{0, 0, -1};
  EXPECT_FALSE(differs({{0.5f, 0, 1}, down, 0.1f}));
  EXPECT_FALSE(differs({{0.2f, 0, 0.3f}, down, 4.0f}));  // inside
  EXPECT_TRUE(differs({{1, 0, 0.2f}, down, 0.5f}));
}

// From afar a sphere is a point; the difference falls with r^2 / d^2.
TEST(SphericalLight, FromAfarIsAPoint) {
  const Receiver floor(lambert(Vec3(0.5f)));
  const Vec3 toCentre{0.3f, 0.4f, 0.9f}, normal = normalize(Vec3{-0.5f, 0.1f, -0.7f});
  const float d2 = lengthSquared(toCentre), d = std::sqrt(d2);
  const float point = 0.5f / kPi * (toCentre.z / d) * (-dot(normal, toCentre) / d) / d2;
  double before = 0.0;
  for (const float radius : {0.2f, 0.1f, 0.05f}) {
    const float light =
        sphericalTransfer({toCentre, normal, radius * radius}, floor.bsdf, 1).value.x;
    const double off = std::fabs(double{light} / double{point} - 1.0);
    if (before > 0.0) {
      EXPECT_NEAR(off / before, 0.25, 0.02);
    }
    before = off;
  }
  EXPECT_LT(before, 2e-3);
}

// Samples of the cone and of the lobe have one mean, with less noise than the cone's alone.
TEST(SphericalLight, OfGlossySurfacesIsTheIntegral) {
  for (const Vec3 wo : {Vec3{0, 0, 1}, Vec3{-1, -0.3f, 0.5f}}) {
    const Receiver metal(glossy(), wo);
    for (const VirtualSphericalLight& vpl : vpls()) {
      const Vec3 expected = integral(vpl, metal.bsdf);
      const Vec3 sampled = sampledSphericalTransfer(vpl, metal.bsdf, kMany, 1);
      EXPECT_NEAR(sampled.x, expected.x, 4e-3f * expected.x + 2e-4f);
      double mean = 0.0;
      for (uint64_t key = 0; key < 1000; ++key)
        mean += double{sphericalTransfer(vpl, metal.bsdf, key).value.x} / 1000;
      EXPECT_NEAR(mean, expected.x, 0.04f * expected.x + 1e-3f);
    }
  }
}

// A lobe reflects at most all light, so that a sphere's light is below 1/(pi r^2), up to noise. A
// point with the same bound on 1/d^2 shows the lobe's peak.
TEST(SphericalLight, HasNoSpikes) {
  const Receiver metal(glossy(), {0, 0, 1});
  const float radius2 = 0.04f, most = 1.0f / (kPi * radius2);
  EXPECT_GT(metal.bsdf.eval(LobeGroup::Rough, {0, 0, 1}).x / radius2, 2.5f * most);
  for (float d = 1.0f; d > 1e-4f; d *= 0.5f) {
    for (uint64_t key = 0; key < 50; ++key) {
      const Vec3 light = sphericalTransfer({{0, 0, d}, {0, 0, -1}, radius2}, metal.bsdf, key).value;
      EXPECT_LT(light.x, 1.2f * most);
    }
  }
}

}  // namespace
}  // namespace bnvpl
