// Glass against the laws of Fresnel and Snell, written here with angles instead of cosines.
#include "tests/transport/plain_scene.h"

namespace bnvpl {
namespace {

Material glass(float ior) {
  Material m;
  m.phong().glass = true;
  m.phong().ior = ior;
  m.phong().mirror = Vec3(1);
  return m;
}
Vec3 at(double degrees) {
  const double a = degrees * double{kPi} / 180.0;
  return {float(std::sin(a)), 0.0f, float(std::cos(a))};
}
// Fresnel's equations in sines and tangents of the two angles.
double fresnelByAngles(double degrees, double eta) {
  const double i = std::max(degrees, 0.01) * double{kPi} / 180.0, t = std::asin(std::sin(i) / eta);
  const double s = std::sin(i - t) / std::sin(i + t), p = std::tan(i - t) / std::tan(i + t);
  return 0.5 * (s * s + p * p);
}

struct Split {
  double reflected = 0.0;  // share of the samples
  Vec3 weightUp, weightDown;
  Vec3 up, down;  // the two directions
};
Split split(const Bsdf& bsdf, TransportMode transport) {
  Split r;
  constexpr int kDraws = 100000;
  for (int i = 0; i < kDraws; ++i) {
    Rng rng(8, uint64_t(i));
    BsdfSample s;
    EXPECT_TRUE(bsdf.sample(LobeGroup::Specular, transport, rng, s));
    EXPECT_EQ(s.pdf, 0.0f);
    const bool isUp = s.wi.z > 0.0f;
    EXPECT_EQ(s.side.z > 0.0f, isUp);
    (isUp ? r.up : r.down) = s.wi;
    (isUp ? r.weightUp : r.weightDown) = s.weight;
    r.reflected += isUp ? 1.0 / kDraws : 0.0;
  }
  return r;
}

TEST(Glass, SharesFollowFresnelAndDirectionsSnell) {
  const Scene scene = sceneOf(glass(1.5f));
  for (const double degrees : {0.0, 30.0, 56.31, 75.0, 88.0}) {
    const SurfacePoint p = pointSeenFrom(at(degrees));
    const Split s = split(Bsdf(scene, p), TransportMode::Importance);
    EXPECT_NEAR(s.reflected, fresnelByAngles(degrees, 1.5), 0.006) << degrees;
    EXPECT_LT(length(s.up - Vec3(-p.wo.x, 0, p.wo.z)), 1e-5f);
    EXPECT_NEAR(s.down.x, -p.wo.x / 1.5f, 1e-5f) << degrees;
    EXPECT_NEAR(length(s.down), 1.0f, 1e-5f);
  }
  EXPECT_NEAR(fresnelByAngles(0, 1.5), 0.04, 1e-4);
}

TEST(Glass, WeightsOfPhotonsSumToOne) {
  Material tinted = glass(1.33f);
  tinted.phong().transmission = {0.5f, 0.7f, 1.0f};
  for (const Material& m : {glass(1.33f), tinted}) {
    const Scene scene = sceneOf(m);
    const SurfacePoint p = pointSeenFrom(at(40));
    const Split s = split(Bsdf(scene, p), TransportMode::Importance);
    expectClose(s.weightUp, Vec3(1), 1e-6f);
    expectClose(s.weightDown, m.phong().transmission, 1e-6f);
  }
}

// Radiance is scaled by 1/eta^2 on one way through the surface and back on the other.
TEST(Glass, RadianceIsScaledByEtaSquared) {
  const Scene scene = sceneOf(glass(1.5f));
  const SurfacePoint outside = pointSeenFrom(at(30)),
                     inside = pointSeenFrom(at(10), {0, 0, 1}, {0, 0, 1}, false);
  const Split in = split(Bsdf(scene, outside), TransportMode::Radiance),
              out = split(Bsdf(scene, inside), TransportMode::Radiance);
  expectClose(in.weightUp, Vec3(1), 1e-6f);
  expectClose(in.weightDown * out.weightDown, Vec3(1), 1e-5f);
  // A camera path enters from air, where radiance is the inside radiance over eta squared.
  expectClose(in.weightDown, Vec3(1.0f / 2.25f), 1e-5f);
  EXPECT_NEAR(out.down.x, -inside.wo.x * 1.5f, 1e-5f);
}

TEST(Glass, ReflectsTotallyBeyondTheCriticalAngle) {
  const Scene scene = sceneOf(glass(1.5f));  // critical angle 41.8 degrees
  for (const auto& [degrees, total] :
       {std::pair{41.0, false}, std::pair{42.5, true}, std::pair{80.0, true}}) {
    const SurfacePoint p = pointSeenFrom(at(degrees), {0, 0, 1}, {0, 0, 1}, false);
    EXPECT_EQ(split(Bsdf(scene, p), TransportMode::Importance).reflected > 0.9999, total)
        << degrees;
  }
}

TEST(Glass, IsSpecularOnly) {
  const Scene scene = sceneOf(glass(1.5f));
  const SurfacePoint p = pointSeenFrom(at(20));
  const Bsdf bsdf(scene, p);
  EXPECT_EQ(bsdf.specularProbability(), 1.0f);
  EXPECT_FALSE(bsdf.hasRough());
  EXPECT_EQ(bsdf.survivalProbability(), 1.0f);
  Rng rng(1, 1);
  BsdfSample s;
  EXPECT_FALSE(bsdf.sample(LobeGroup::Rough, TransportMode::Radiance, rng, s));
  EXPECT_EQ(bsdf.eval(LobeGroup::Specular, {0, 0, 1}), Vec3());
}

}  // namespace
}  // namespace bnvpl
