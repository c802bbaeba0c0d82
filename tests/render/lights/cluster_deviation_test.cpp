// Expected light of a cluster in tile cuts, and the quick test that avoids computing it.
#include "tools/render/light_tree/cluster_deviation.h"

#include <gtest/gtest.h>

#include "core/random.h"
#include "core/random_streams.h"
#include "core/sampling.h"

namespace bnvpl::test {
namespace {

Vec3 somewhere(Rng& rng) { return Vec3{rng.next(), rng.next(), rng.next()}; }
Vec3 someDirection(Rng& rng) {
  const float u = rng.next(), v = rng.next();
  return sampleSphere(u, v);
}

Bounds boxAbout(Vec3 center, Rng& rng) {
  Bounds b;
  for (int corner = 0; corner < 2; ++corner) b.extend(center + somewhere(rng) - Vec3(0.5f));
  return b;
}

LightNode cluster(Rng& rng) {
  LightNode n;
  n.bounds = boxAbout({}, rng);
  n.left = 1, n.right = 2;
  n.axis = someDirection(rng);
  n.cosHalfAngle = 2.0f * rng.next() - 1.0f;
  n.sinHalfAngle = n.cosHalfAngle > 0.0f ? std::sqrt(1.0f - n.cosHalfAngle * n.cosHalfAngle) : 1.0f;
  n.intensity = somewhere(rng);
  n.size2 = 0.01f * rng.next();
  return n;
}

// Clusters near and far, receivers with small and large BSDF values. Where the quick test says
// faint, no receiver in the box gets more light than allowed.
TEST(DeviationModel, TheFaintTestIsConservative) {
  Rng rng(streamKey(11, RandomStream::Plot), 0);
  int faint = 0, exceeded = 0;
  for (int i = 0; i < 20000; ++i) {
    const LightNode n = cluster(rng);
    const Bounds receivers = boxAbout(4.0f * (somewhere(rng) - Vec3(0.5f)), rng);
    const float brightest = 10.0f * rng.next();
    float allowed = 10.0f * rng.next();
    allowed *= rng.next();
    const bool says = surelyFaint(n, allowed, receivers, brightest);
    faint += says;
    const DeviationModel<PointLight> expected(n);
    for (int k = 0; k < 16; ++k) {
      const Vec3 at = receivers.lower + receivers.extent() * somewhere(rng);
      const Vec3 normal = someDirection(rng);
      const bool too = expected.at(at, normal, brightest * somewhere(rng)).exceeds(allowed) != 0;
      exceeded += too;
      EXPECT_FALSE(says && too) << i;
    }
  }
  EXPECT_GT(faint, 2000);
  EXPECT_GT(exceeded, 2000);
}

// No light arrives behind either side, and light falls with the square of the distance.
TEST(DeviationModel, KnowsSidesAndDistance) {
  LightNode n;
  n.bounds.extend({-0.01f, -0.01f, 0.0f});
  n.bounds.extend({0.01f, 0.01f, 0.0f});
  n.left = 1, n.right = 2;
  n.axis = {0, 0, 1};
  n.intensity = Vec3(1.0f);
  const DeviationModel<PointLight> expected(n);
  const Vec3 white(1.0f / kPi);
  const float near = expected.at({0, 0, 1}, {0, 0, -1}, white).maxDraw,
              twice = expected.at({0, 0, 2}, {0, 0, -1}, white).maxDraw;
  EXPECT_NEAR(near, 3.0f / kPi, 1e-2f);
  EXPECT_NEAR(twice / near, 0.25f, 1e-3f);
  EXPECT_EQ(expected.at({0, 0, 1}, {0, 0, 1}, white).maxDraw, 0.0f);
  EXPECT_EQ(expected.at({0, 0, -1}, {0, 0, 1}, white).maxDraw, 0.0f);
}

}  // namespace
}  // namespace bnvpl::test
