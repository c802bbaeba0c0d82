#include <gtest/gtest.h>

#include "tests/support/pipeline.h"
#include "tools/common/streams.h"

namespace bnvpl::test {
namespace {

struct Lit {
  Lit() : world("cornell/scene.toml") {
    world.scene.film = {40, 40};
    settings.vpls = 2000;
    settings.film = {.spp = 1, .only = Only::Indirect, .layers = kLayerCutSize};
    vpls = lightUp(world, settings);
  }
  World world;
  VplSettings settings;
  VplTable vpls;
};

const Lit& lit() {
  static const Lit l;
  return l;
}

Image render(const GatherOptions& gather) {
  VplSettings s = lit().settings;
  s.gather = gather;
  FilmStats stats;
  return renderVpls(lit().world, lit().vpls, s, stats);
}

double relativeDifference(const Image& a, const Image& b) {
  double difference = 0.0, sum = 0.0;
  for (const char* c : {"R", "G", "B"}) {
    const auto &x = *a.find(c), &y = *b.find(c);
    for (size_t i = 0; i < x.size(); ++i) {
      difference += std::fabs(double{x[i]} - double{y[i]});
      sum += double{y[i]};
    }
  }
  return difference / sum;
}

TEST(Lightcuts, WithoutToleratedErrorIsTheSumOverAll) {
  const Image all = render({.method = GatherMethod::All});
  const Image cuts = render({.method = GatherMethod::Lightcuts, .error = 0.0f, .maxCut = 1000000});
  const auto &x = *all.find("R"), &y = *cuts.find("R");
  for (size_t i = 0; i < x.size(); ++i) ASSERT_NEAR(y[i], x[i], 1e-5f * (x[i] + 1e-3f)) << i;
}

TEST(Lightcuts, AtTwoPercentStaysNearTwoPercent) {
  const Image all = render({.method = GatherMethod::All});
  const Image cuts = render({.method = GatherMethod::Lightcuts});
  EXPECT_LT(relativeDifference(cuts, all), 0.02);
  EXPECT_GT(relativeDifference(cuts, all), 0.0);  // it did save work
}

TEST(Lightcuts, TheCutIsBounded) {
  const Image cuts = render({.method = GatherMethod::Lightcuts, .error = 0.0f, .maxCut = 100});
  for (const float c : *cuts.find("cutsize")) EXPECT_LE(c, 100.0f);
  const Image loose = render({.method = GatherMethod::Lightcuts, .error = 0.2f});
  double mean = 0.0;
  for (const float c : *loose.find("cutsize")) mean += double{c} / double(loose.pixelCount());
  EXPECT_LT(mean, 500.0);
}

TEST(LightTree, EveryNodeHoldsItsLights) {
  const VplLights vpls = makeVplLights(lit().vpls, lit().world.rays, 1.0f);
  const LightTree tree = buildLightTree(vpls, 1);
  ASSERT_EQ(tree.nodes.size(), 2 * vpls.size() - 1);
  // From the leaves up (children come after their parent): collect each node's lights.
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
      EXPECT_GE(vpls.clamp2[i], node.clamp2);
    }
    EXPECT_TRUE(representativeInside);
    EXPECT_NEAR(mean(sum), mean(node.intensity), 1e-4f * mean(sum));
  }
  EXPECT_EQ(below[0].size(), vpls.size());
}

// The sampled gather and the sum over all VPLs agree on the mean, point by point and channel by
// channel.
TEST(SampledGather, IsTheSumOverAllOnAverage) {
  const Lit& l = lit();
  const VplLights vpls = makeVplLights(l.vpls, l.world.rays, 1.0f);
  const Gatherer gatherer(l.world.rays, vpls, {.method = GatherMethod::All}, 1);
  const Vec3 middle = l.world.scene.camera.position;
  Rng rng(streamKey(5, Stream::PixelSamples), 0);
  int points = 0;
  while (points < 6) {
    SurfacePoint hit;
    const Vec3 direction = normalize(l.world.scene.camera.forward +
                                     0.3f * Vec3{rng.next() - 0.5f, rng.next() - 0.5f, 0.0f});
    if (!l.world.rays.closestHit(middle, direction, hit)) continue;
    const Bsdf bsdf(l.world.scene, hit);
    const std::array<const Bsdf*, 1> receiver{&bsdf};
    std::array<Gathered, 1> gathered;
    gatherer.gather({{.pixels = 1}, receiver}, gathered);
    const Vec3 all = gathered[0].radiance;
    if (mean(all) <= 0.0f) continue;
    ++points;
    for (const unsigned draws : {8u, 2u, 1u}) {
      constexpr int kTimes = 4000;
      Vec3 sum;
      double squares = 0.0;
      for (int k = 0; k < kTimes; ++k) {
        const Vec3 radiance = gatherer.sample(bsdf, draws, rng).radiance;
        sum += radiance * (1.0f / kTimes);
        squares += std::pow(double{mean(radiance)} / double{mean(all)}, 2) / kTimes;
      }
      // Of one gather, relative: the tree knows where the light is.
      const double deviation = std::sqrt(std::max(0.0, squares - 1.0));
      EXPECT_LT(deviation, 0.8 * std::sqrt(8.0 / draws));
      const double allowed = 5.0 * deviation / std::sqrt(double{kTimes});
      EXPECT_NEAR(mean(sum) / mean(all), 1.0, allowed);
      EXPECT_NEAR(sum.x / all.x, 1.0, 2.0 * allowed);
    }
  }
}

}  // namespace
}  // namespace bnvpl::test
