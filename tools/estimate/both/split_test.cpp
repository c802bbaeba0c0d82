#include "tools/estimate/both/split.h"

#include <gtest/gtest.h>

#include "core/random.h"
#include "tests/support/pipeline.h"

namespace bnvpl::test {
namespace {

using namespace methods::estimate::both;

// Estimate of a pilot that found few samples, one in twenty of which is twenty times as bright.
PilotEstimate fewSamples(Rng& rng) {
  PilotEstimate found;
  for (float product = rng.next(); product > 0.6f; product *= rng.next()) {
    const double size = rng.next() < 0.05f ? 20.0 : 1.0;
    found.flux += size;
    found.variance += size * size;
    found.varianceByPower = found.variance;
  }
  return found;
}

// Photons and paths are equally good everywhere, but the pilots found few samples. Weights that
// believed the variances of these would waste work.
TEST(Both, WeightsAreNotLedByFewSamplesOfThePilots) {
  constexpr size_t kSide = 30, kVpls = kSide * kSide;
  constexpr double kTimes = 30.0;  // work over that of a pilot
  const World world("test/two-patches.toml");
  VplTable vpls;
  Pilots pilots;
  pilots.photons = kVpls, pilots.points = 1.0, pilots.photonPower = 1.0, pilots.photonCost = 1.0;
  pilots.pointCost.assign(kVpls, 1.0);
  Rng rng(7, 0);
  double variance = 0.0;  // mean over both pilots
  for (size_t i = 0; i < kVpls; ++i) {
    vpls.position.push_back({float(i % kSide), float(i / kSide), 0.0f});
    vpls.normal.push_back({0, 0, 1});
    for (std::vector<PilotEstimate>* pilot : {&pilots.byPhotons, &pilots.byPaths}) {
      pilot->push_back(fewSamples(rng));
      variance += pilot->back().variance / (2.0 * kVpls);
    }
  }
  const Split split = splitWork(vpls, world.accel, pilots, {kTimes * kVpls, 0.0});
  double result = 0.0;
  for (size_t i = 0; i < kVpls; ++i) {
    const double w = 1.0 / (1.0 + double{split.misRatio[i]});
    const double points = std::max(1e-3, double(split.points[i]));
    result += variance * (w * w * kVpls / double(split.photons) + (1.0 - w) * (1.0 - w) / points);
  }
  EXPECT_LT(result / kVpls / (variance / kTimes), 1.5);
}

// Photons and paths are equally good at one watt; the other nine, only photons find.
TEST(Both, LightThatOnlyPhotonsFindHasItsPhotons) {
  constexpr size_t kSide = 20, kVpls = kSide * kSide;
  const World world("test/two-patches.toml");
  VplTable vpls;
  Pilots pilots;
  pilots.photons = kVpls, pilots.points = 1.0, pilots.photonPower = 1.0, pilots.photonCost = 1.0;
  pilots.pointCost.assign(kVpls, 1.0);
  for (size_t i = 0; i < kVpls; ++i) {
    vpls.position.push_back({float(i % kSide), float(i / kSide), 0.0f});
    vpls.normal.push_back({0, 0, 1});
    pilots.byPhotons.push_back({1.0, 1.0, 1.0, 9.0, 9.0});
    pilots.byPaths.push_back({1.0, 1.0});
  }
  constexpr double kWork = 30.0 * kVpls;
  EXPECT_GT(double(splitWork(vpls, world.accel, pilots, {kWork, 0.0}).photons), 0.75 * kWork);
}

}  // namespace
}  // namespace bnvpl::test
