// VPLs drawn one at a time: every VPL that lights a point can be drawn, with the right probability.
#include "tools/render/light_tree/vpl_sampler.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <set>

#include "core/random_streams.h"
#include "tests/render/lights/random_lights.h"

namespace bnvpl::test {
namespace {

struct Mean {
  double sum = 0.0, squares = 0.0;
  void add(double value) { sum += value, squares += value * value; }
  double over(int n) const { return sum / n; }
  double deviation(int n) const {  // standard deviation of the mean
    return std::sqrt(std::max(0.0, squares / n - over(n) * over(n)) / n);
  }
};

// A drawn VPL that can light the point counts one over its probability: the expected count is the
// number of such VPLs.
void requireRightProbabilities(size_t count, bool glossy) {
  Rng rng(streamKey(count, RandomStream::Plot), glossy);
  const VplLights lights = lightsAbout(count, rng);
  const LightTree tree = buildLightTree(lights, 1);
  const VplSampler sampler(tree);
  const Scene scene = withMaterial(glossy);
  int lit = 0;
  for (int k = 0; k < 40; ++k) {
    const SurfacePoint at = pointIn(rng);
    const Bsdf bsdf(scene, at);
    std::map<uint32_t, double> sends;  // light of the VPLs that can light the point
    double all = 0.0;
    VplTransfer c;
    for (uint32_t i = 0; i < count; ++i) {
      if (!unoccludedTransfer(lights, i, bsdf, c)) continue;
      all += sends[i] = double{mean(c.transfer * lights.intensity[i])};
    }
    const VplSampler::Point point(sampler, bsdf);
    if (point.dark()) {
      EXPECT_TRUE(sends.empty());
      continue;
    }
    ++lit;
    constexpr int kDraws = 40000;
    Mean number, light;  // estimated number of VPLs and their light
    std::set<uint32_t> drawn;
    const float shift = rng.next();
    for (int d = 0; d < kDraws; ++d) {
      const auto draw = point.draw((static_cast<float>(d) + shift) / kDraws, rng);
      if (!draw) continue;
      ASSERT_LT(draw->vpl, count);
      ASSERT_GT(draw->probability, 0.0f);
      ASSERT_LE(draw->probability, 1.0001f);
      const auto found = sends.find(draw->vpl);
      if (found == sends.end()) continue;
      drawn.insert(draw->vpl);
      number.add(1.0 / double{draw->probability});
      light.add(found->second / double{draw->probability});
    }
    EXPECT_NEAR(number.over(kDraws), double(sends.size()),
                6.0 * number.deviation(kDraws) + 1e-3 * double(sends.size()))
        << count << " VPLs, point " << k;
    EXPECT_NEAR(light.over(kDraws), all, 6.0 * light.deviation(kDraws) + 1e-3 * all)
        << count << " VPLs, point " << k;
    for (const auto& [vpl, sent] : sends) {
      EXPECT_TRUE(sent < 0.002 * all || drawn.contains(vpl)) << vpl << " sends " << sent / all;
    }
  }
  EXPECT_GT(lit, 4);
}

TEST(VplSampler, ProbabilitiesAreRight) {
  for (const size_t count : {1u, 3u, 33u, 500u}) requireRightProbabilities(count, false);
}

TEST(VplSampler, ProbabilitiesAreRightForLobes) {
  for (const size_t count : {2u, 40u, 500u}) requireRightProbabilities(count, true);
}

// A rough coat with a normal of its own mirrors the viewer towards one of two VPLs, which are alike
// for the base.
TEST(VplSampler, CoatsAreBoundedAboutTheirOwnAxis) {
  Scene scene = withMaterial(false);
  MetallicRoughnessModel coated;
  coated.baseColour = Colour(Vec3(0.0f));
  coated.metallic = Scalar(0.0f);
  coated.clearcoat = Scalar(1.0f);
  coated.clearcoatRoughness = Scalar(0.6f);
  scene.materials[0].model = coated;
  const Vec3 tilt = normalize(Vec3{0.4f, 0, 1}), wo{0, 0, 1};
  const Vec3 mirrored = 2.0f * dot(tilt, wo) * tilt - wo, other{-mirrored.x, 0, mirrored.z};
  VplLights lights;
  for (const Vec3 to : {mirrored, other}) {
    lights.position.push_back(to);
    lights.normal.push_back(-to);
    lights.intensity.push_back(Vec3(1.0f));
    lights.size2.push_back(1e-6f);
  }
  SurfacePoint at;
  at.ng = at.ns = {0, 0, 1};
  at.coat = tilt, at.wo = wo, at.material = 0;
  const Bsdf bsdf(scene, at);
  const LightTree tree = buildLightTree(lights, 1);
  const VplSampler sampler(tree);
  const VplSampler::Point point(sampler, bsdf);
  std::array<double, 2> light{}, probability{};
  for (uint32_t i : {0u, 1u}) {
    VplTransfer c;
    ASSERT_TRUE(unoccludedTransfer(lights, i, bsdf, c));
    light[i] = double{mean(c.transfer)};
  }
  Rng rng(1, 2);
  for (const float u : {0.01f, 0.99f}) {
    const auto draw = point.draw(u, rng);
    ASSERT_TRUE(draw.has_value());
    probability[draw->vpl] = double{draw->probability};
  }
  const double share = light[0] / (light[0] + light[1]);
  ASSERT_GT(share, 0.8);
  EXPECT_NEAR(probability[0], share, 0.15);
}

TEST(VplSampler, WithoutVplsAllIsDark) {
  const Scene scene = withMaterial(false);
  Rng rng(1, 1);
  const SurfacePoint at = pointIn(rng);
  const Bsdf bsdf(scene, at);
  EXPECT_TRUE(VplSampler::Point(VplSampler(LightTree{}), bsdf).dark());
}

}  // namespace
}  // namespace bnvpl::test
