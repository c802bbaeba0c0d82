// The light tree, and VPLs sampled from it.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <fstream>

#include "core/errors.h"
#include "core/random_streams.h"
#include "tests/support/gather_checks.h"
#include "tests/support/gather_of.h"
#include "tests/support/pipeline.h"
#include "tests/support/sanitizers.h"
#include "tools/render/gather/single_vpl.h"

namespace bnvpl::test {
namespace {

const GatherCase& lit() {
  static const GatherCase c("cornell/scene.toml", {40, 40}, {{"count", "2000"}},
                            {{"method", "guarded"}});
  return c;
}

TEST(LightTree, IsRefusedWhereItDoesNotFit) {
  if (kSanitized) GTEST_SKIP() << "sanitizers reserve terabytes of addresses";
  VplLights million;
  million.position.resize(1000000);
  uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_AS, &before), 0);
  rlimit tight = before;
  tight.rlim_cur = pages * static_cast<uint64_t>(::sysconf(_SC_PAGESIZE)) + (uint64_t{100} << 20);
  ASSERT_EQ(::setrlimit(RLIMIT_AS, &tight), 0);
  std::string message;
  try {
    buildLightTree(million, 1);
  } catch (const MemoryError& e) {
    message = e.what();
  }
  ::setrlimit(RLIMIT_AS, &before);
  EXPECT_NE(message.find("the light tree of 1000000 emission points needs about"),
            std::string::npos)
      << message;
  EXPECT_NE(message.find("--emit-points"), std::string::npos) << message;
}

TEST(LightTree, EveryNodeHoldsItsLights) {
  const VplLights vpls = makeVplLights(lit().lit, lit().world.accel, 1.0f);
  const LightTree tree = buildLightTree(vpls, 1);
  ASSERT_EQ(tree.nodes.size(), 2 * vpls.size() - 1);
  // From the leaves up (children come after their parent), collect each node's lights.
  std::vector<std::vector<uint32_t>> below(tree.nodes.size());
  for (size_t n = tree.nodes.size(); n-- > 0;) {
    const LightNode& node = tree.nodes[n];
    if (node.leaf()) {
      below[n] = {node.representative};
      continue;
    }
    below[n] = below[node.left];
    below[n].insert(below[n].end(), below[node.right].begin(), below[node.right].end());
    Vec3 sum;
    bool representativeInside = false;
    for (const uint32_t i : below[n]) {
      sum += vpls.intensity[i];
      representativeInside |= i == node.representative;
      EXPECT_GE(dot(vpls.normal[i], node.axis), node.cosHalfAngle - 1e-4f);
      EXPECT_EQ(node.bounds.distanceSquared(vpls.position[i]), 0.0f);
      EXPECT_GE(vpls.size2[i], node.size2);
    }
    EXPECT_TRUE(representativeInside);
    EXPECT_NEAR(mean(sum), mean(node.intensity), 1e-4f * mean(sum));
  }
  EXPECT_EQ(below[0].size(), vpls.size());
}

// Relative standard deviation of a gather of one VPL that is drawn uniformly.
double deviationOfAnyVpl(const World& world, const VplLights& vpls, const Bsdf& bsdf) {
  const ShadowTest one(world.accel, vpls, bsdf);
  double sum = 0.0, squares = 0.0;
  for (size_t i = 0; i < vpls.size(); ++i) {
    const double contribution = mean(one.of(i).radiance);
    sum += contribution;
    squares += contribution * contribution;
  }
  return std::sqrt(std::max(0.0, static_cast<double>(vpls.size()) * squares / (sum * sum) - 1.0));
}

// The mean of the sampled gather equals the sum over all VPLs at every point and in every channel.
TEST(SampledGather, IsTheSumOverAllOnAverage) {
  const World& world = lit().world;
  const VplLights vpls = makeVplLights(lit().lit, world.accel, 1.0f);
  const GatherOf gather(world, vpls, {{"gather", "all"}});
  const Vec3 middle = world.scene.camera.position;
  Rng rng(streamKey(5, RandomStream::PixelSamples), 0);
  int points = 0, cases = 0;
  double shares = 0.0;
  while (points < 6) {
    SurfacePoint hit;
    const Vec3 direction = normalize(world.scene.camera.forward +
                                     0.3f * Vec3{rng.next() - 0.5f, rng.next() - 0.5f, 0.0f});
    if (!world.accel.closestHit(middle, direction, hit)) continue;
    const Bsdf bsdf(world.scene, hit);
    const Vec3 all = gather.at(bsdf).radiance;
    if (mean(all) <= 0.0f) continue;
    ++points;
    const double blind = deviationOfAnyVpl(world, vpls, bsdf);
    for (const unsigned draws : {8u, 2u, 1u}) {
      constexpr int kTimes = 4000;
      Vec3 sum;
      double squares = 0.0;
      for (int k = 0; k < kTimes; ++k) {
        const Vec3 radiance = gather.point(bsdf, draws, rng).radiance;
        sum += radiance * (1.0f / kTimes);
        squares += std::pow(double{mean(radiance)} / double{mean(all)}, 2) / kTimes;
      }
      // Relative standard deviation of one gather; the tree directs samples to bright VPLs.
      const double deviation = std::sqrt(std::max(0.0, squares - 1.0));
      const double ofBlind = deviation * std::sqrt(draws) / blind;
      EXPECT_LT(ofBlind, 1.0);
      shares += ofBlind;
      ++cases;
      const double allowed = 5.0 * deviation / std::sqrt(double{kTimes});
      EXPECT_NEAR(mean(sum) / mean(all), 1.0, allowed);
      EXPECT_NEAR(sum.x / all.x, 1.0, 2.0 * allowed);
    }
  }
  EXPECT_LT(shares / cases, 0.75);
}

}  // namespace
}  // namespace bnvpl::test
