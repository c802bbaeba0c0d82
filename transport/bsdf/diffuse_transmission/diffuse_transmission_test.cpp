// Lambertian reflection and transmission.
#include "transport/bsdf/diffuse_transmission/diffuse_transmission.h"

#include "tests/support/bsdf_checks.h"

namespace bnvpl::test {
namespace {

TEST(DiffuseTransmission, KeepsToWhatEveryModelDoes) {
  check(materialOf(DiffuseTransmissionModel{Vec3(0.5f, 0.2f, 0.1f), Vec3(0.3f, 0.4f, 0.6f)}),
        "paper", 1e-3f);
}

TEST(DiffuseTransmission, SharesOutBetweenTheSides) {
  const Scene scene =
      sceneOf(materialOf(DiffuseTransmissionModel{Vec3(0.5f, 0.2f, 0.1f), Vec3(0.3f, 0.4f, 0.6f)}));
  const SurfacePoint p = seenFrom(views()[1]);
  const Bsdf bsdf(scene, p);
  expectClose(bsdf.roughAlbedo(), {0.5f, 0.2f, 0.1f}, 1e-5f);
  expectClose(bsdf.eval(LobeGroup::Specular, {0, 0, -1}), Vec3(0.3f, 0.4f, 0.6f) / kPi, 1e-5f);
  EXPECT_EQ(bsdf.eval(LobeGroup::Specular, {0, 0, 1}), Vec3());
  EXPECT_FALSE(bsdf.specularIsDelta());
  forEachSample(bsdf, LobeGroup::Specular, TransportMode::Radiance, 100, [](const BsdfSample& s) {
    EXPECT_LT(s.wi.z, 0.0f);
    expectClose(s.weight, {0.3f, 0.4f, 0.6f}, 1e-5f);
  });
}

TEST(DiffuseTransmission, GivesBackNoMoreThanArrives) {
  const Material m = materialOf(DiffuseTransmissionModel{Vec3(0.9f), Vec3(0.9f)});
  expectClose(furnace(m, views()[1]), Vec3(1), 1e-4f);
}

}  // namespace
}  // namespace bnvpl::test
