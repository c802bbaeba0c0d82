// Photons are shared among lights of any power, and their weights preserve the energy.
#include "tools/estimate/photons_per_light.h"

#include <gtest/gtest.h>

#include "tests/support/grey_cube.h"
#include "tests/transport/plain_scene.h"

namespace bnvpl::test {
namespace {

using Counts = std::vector<uint64_t>;

// A scene with a point light of each intensity, in W/sr in all channels.
World lampsOf(const std::vector<float>& intensities) {
  Scene scene = floorScene();
  for (const float intensity : intensities) {
    LightSpec l;
    l.position = {0, 1, 0};
    l.emission = Vec3(intensity);
    scene.lights.push_back(l);
  }
  return World(std::move(scene));
}

// Counts the photons of each light. Photons are ordered by light, and their weights sum to 1.
Counts countsOf(const World& world, const PhotonsPerLight& perLight) {
  Counts counts(world.lights.size(), 0);
  size_t before = 0;
  for (uint64_t photon = 0; photon < perLight.total(); ++photon) {
    const size_t light = perLight.lightOf(photon);
    EXPECT_LT(light, counts.size());
    EXPECT_GE(light, before) << photon;
    before = light;
    ++counts.at(light);
  }
  for (size_t l = 0; l < counts.size(); ++l) {
    if (counts[l] == 0) continue;
    EXPECT_FLOAT_EQ(perLight.weight(l) * static_cast<float>(counts[l]), 1.0f) << l;
  }
  return counts;
}
Counts countsOf(const std::vector<float>& intensities, uint64_t photons) {
  const World world = lampsOf(intensities);
  return countsOf(world, PhotonsPerLight(world.lights, photons));
}

TEST(PhotonsPerLight, AreInProportionToPower) {
  EXPECT_EQ(countsOf({1, 2, 5, 1000}, 10080), (Counts{10, 20, 50, 10000}));
  EXPECT_EQ(countsOf({1000, 5, 2, 1}, 10080), (Counts{10000, 50, 20, 10}));
}

TEST(PhotonsPerLight, WhatIsLeftGoesToTheLargestRemainders) {
  EXPECT_EQ(countsOf({1, 1, 1}, 100), (Counts{34, 33, 33}));  // among equals the first
  EXPECT_EQ(countsOf({26, 37, 37}, 10), (Counts{2, 4, 4}));   // shares 2.6, 3.7, 3.7
  EXPECT_EQ(countsOf({51, 53, 56}, 16), (Counts{5, 5, 6}));   // shares 5.1, 5.3, 5.6
}

// One photon already exceeds such a light's share, whatever its remainder.
TEST(PhotonsPerLight, ALightWithAShareBelowOneGetsExactlyOne) {
  EXPECT_EQ(countsOf({555, 555, 90}, 12), (Counts{6, 5, 1}));  // shares 5.55, 5.55, 0.9
  EXPECT_EQ(countsOf({1e-6f, 1, 1e-9f}, 1000), (Counts{1, 999, 1}));
  EXPECT_EQ(countsOf({1, 1, 1, 1, 1}, 2), (Counts{1, 1, 1, 1, 1}));
}

TEST(PhotonsPerLight, ALightWithoutPowerGetsNone) {
  EXPECT_EQ(countsOf({0, 3, 0, 1, 0}, 8), (Counts{0, 6, 0, 2, 0}));
  EXPECT_EQ(countsOf({0, 3, 0, 1, 0}, 1), (Counts{0, 1, 0, 1, 0}));
}

// Every light's count is within one photon of its share, and all photons are distributed.
TEST(PhotonsPerLight, ManyLightsOfAnyPower) {
  std::vector<float> intensities;
  Rng rng(3, 0);
  double sum = 0.0;
  for (int l = 0; l < 300; ++l) {
    intensities.push_back(std::pow(10.0f, 2.0f * rng.next()));
    sum += double{intensities.back()};
  }
  constexpr uint64_t kPhotons = 200000;
  const Counts counts = countsOf(intensities, kPhotons);
  uint64_t total = 0;
  for (size_t l = 0; l < counts.size(); ++l) {
    const double share = double{intensities[l]} / sum * double{kPhotons};
    EXPECT_LT(std::fabs(double(counts[l]) - share), 1.001) << l;
    total += counts[l];
  }
  EXPECT_EQ(total, kPhotons);
}

// In a closed box of albedo 0.5 each photon reflects half of its flux at every hit. The number of
// hits has mean 2 and variance 2, so n photons reflect their emitted flux to within 0.71/sqrt(n).
TEST(PhotonsPerLight, WeightsKeepTheEnergyOfEachLight) {
  const World world = greyCube({{1, 0, 0}, {0, 0, 0.04f}});
  const VplTable vpls = keptVpls(world, {{"count", "200"}}, {{"count", "4000"}});
  const EstimateResult result =
      lightVpls(world, vpls, {{"photons", "104k"}, {"radius", "3"}});  // 100000 and 4000
  const EnergyAccount& account = result.energy;
  EXPECT_NEAR(account.emitted, double{mean(world.lights.totalPower())}, 1e-6 * account.emitted);
  ASSERT_GT(account.deposited, 0.999 * account.reflected);
  std::array<double, 3> flux{};
  for (const Vec3 f : result.table.flux) {
    for (size_t c = 0; c < 3; ++c) flux[c] += double{f[c]};
  }
  const auto expectPower = [&](double got, double intensity, double photons) {
    EXPECT_NEAR(got / (4.0 * double{kPi} * intensity), 1.0, 4.0 * 0.71 / std::sqrt(photons) + 1e-3);
  };
  expectPower(flux[0], 1.0, 100000);
  expectPower(flux[2], 0.04, 4000);
  EXPECT_EQ(flux[1], 0.0);
}

}  // namespace
}  // namespace bnvpl::test
