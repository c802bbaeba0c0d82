// Upper bounds of the light of clusters: no VPL that represents one may exceed them.
#include "tools/render/light_tree/cluster_bounds.h"

#include <gtest/gtest.h>

#include "core/random_streams.h"
#include "tests/render/lights/random_lights.h"
#include "tools/render/gather/receiver_tree.h"
#include "tools/render/light_tree/normal_cone.h"
#include "transport/virtual_light/spherical/spherical_transfer.h"

namespace bnvpl::test {
namespace {

// BSDF, cosines and falloff of a VPL. Means over directions of spheres take many samples.
Vec3 transferOf(const VplLights& vpls, size_t i, const Bsdf& bsdf) {
  VplTransfer found;
  if (!unoccludedTransfer(vpls, i, bsdf, found)) return {};
  if (!found.sampled) return found.transfer;
  const Vec3 d = vpls.position[i] - bsdf.point().position;
  return sampledSphericalTransfer({d, vpls.normal[i], vpls.size2[i]}, bsdf, 512, 7 + i);
}

float sumOf(Vec3 v) { return v.x + v.y + v.z; }

// The normals of a tilted wall, whose cosine with themselves may round to less than 1.
TEST(NormalCones, OfEqualNormalsHaveNoAngle) {
  Rng rng(streamKey(4, RandomStream::Plot), 0);
  for (int i = 0; i < 1000; ++i) {
    const float u = rng.next(), v = rng.next();
    const Vec3 normal = sampleSphere(u, v);
    const NormalCone cone = merged(merged({normal}, {normal}), {normal});
    EXPECT_EQ(cone.cosHalfAngle, 1.0f) << i;
  }
}

TEST(NormalCones, HoldWhatTheyAreMergedFrom) {
  Rng rng(streamKey(5, RandomStream::Plot), 0);
  for (int i = 0; i < 2000; ++i) {
    const float u = rng.next(), v = rng.next(), spread = std::pow(10.0f, -6.0f * rng.next());
    const Vec3 axis = sampleSphere(u, v);
    std::vector<Vec3> normals;
    NormalCone cone{};
    for (int k = 0; k < 8; ++k) {
      const float s = rng.next(), t = rng.next();
      normals.push_back(normalize(axis + sampleSphere(s, t) * spread));
      cone = k == 0 ? NormalCone{normals[0]} : merged(cone, {normals.back()});
    }
    for (const Vec3 n : normals) EXPECT_GE(dot(n, cone.axis), cone.cosHalfAngle - 2e-6f) << i;
    if (spread < 0.1f) {
      EXPECT_GT(cone.cosHalfAngle, 0.9f) << spread;
    }
  }
}

class ClusterBounds : public testing::TestWithParam<std::tuple<std::string_view, bool>> {
 protected:
  ClusterBounds() : scene(withMaterial(std::get<1>(GetParam()))) {
    Rng rng(streamKey(9, RandomStream::Plot), 0);
    vpls = lightsAbout(24, rng);
    vpls.kind = vplKindNamed(std::get<0>(GetParam()));
    tree = buildLightTree(vpls, 1);
    for (int k = 0; k < 150; ++k) points.push_back(pointIn(rng));
    for (const SurfacePoint& p : points) {
      bsdfs.emplace_back(scene, p);
      for (size_t i = 0; i < vpls.size(); ++i)
        transfers.push_back(transferOf(vpls, i, bsdfs.back()));
    }
  }
  // The most light that the cluster sends to a point if one of its VPLs represents it.
  float mostAt(const LightNode& n, size_t point) const {
    float most = 0.0f;
    for (uint32_t k = n.begin; k < n.end; ++k)
      most = std::max(most, sumOf(transfers[point * vpls.size() + tree.order[k]] * n.intensity));
    return most;
  }
  Scene scene;
  VplLights vpls;
  LightTree tree;
  std::vector<SurfacePoint> points;
  std::vector<Bsdf> bsdfs;
  std::vector<Vec3> transfers;
};

constexpr float kSampled = 1.02f;  // means of samples have noise

TEST_P(ClusterBounds, HoldAtEveryPoint) {
  int near = 0, bounded = 0;  // pairs of VPLs
  for (size_t k = 0; k < points.size(); ++k) {
    const ClusterReceiver receiver(bsdfs[k]);
    for (const LightNode& n : tree.nodes) {
      if (n.leaf()) continue;
      const float bound = errorBound(n, receiver), light = mostAt(n, k);
      EXPECT_LE(light, kSampled * bound + 1e-6f) << k;
      if (!(light > 0.0f) || n.end - n.begin > 2) continue;
      ++bounded;
      near += 10.0f * light > bound;
    }
  }
  EXPECT_GT(bounded, 300);
  EXPECT_GT(5 * near, bounded);  // infinite bounds would hold, too
}

TEST_P(ClusterBounds, HoldForEveryPairOfClusters) {
  std::vector<ReceiverBsdf> ofPoints;
  for (const Bsdf& b : bsdfs) ofPoints.emplace_back(b);
  const ReceiverTree receivers = buildReceiverTree(points, ofPoints, 0.1f);
  for (const ReceiverNode& r : receivers.nodes) {
    for (const LightNode& n : tree.nodes) {
      float light = 0.0f;
      for (uint32_t k = r.begin; k < r.end; ++k)
        light = std::max(light, mostAt(n, receivers.order[k]));
      const Bsdf* only = r.leaf() ? &bsdfs[receivers.order[r.begin]] : nullptr;
      EXPECT_LE(light, kSampled * pairBound(n, r, only) + 1e-6f);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, ClusterBounds,
                         testing::Combine(testing::ValuesIn(VplKinds::names), testing::Bool()));

}  // namespace
}  // namespace bnvpl::test
