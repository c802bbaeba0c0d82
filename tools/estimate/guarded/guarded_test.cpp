#include <gtest/gtest.h>

#include "tests/support/pipeline.h"

namespace bnvpl::test {
namespace {

// In a closed box every hit lies in the region, so no flux may be lost. With albedo 0.5 and an area
// light on every wall, the reflected flux is the emitted flux times 0.5 / (1 - 0.5).
TEST(Guarded, ClosedBoxLosesNothing) {
  const World world("furnace/scene.toml");
  for (const char* density : {"uniform", "local"}) {
    const VplTable vpls = keptVpls(world, {{"density", density}});
    const EnergyAccount a = lightVpls(world, vpls, {{"photons", "200k"}, {"radius", "2"}}).energy;
    EXPECT_NEAR(a.reflected / a.emitted, 1.0, 0.01);
    EXPECT_GT(a.deposited / a.reflected, 0.995);
    EXPECT_EQ(a.escaped, 0.0);
  }
}

TEST(Guarded, NoLightLeaksIntoAClosedRoom) {
  for (const char* name : {"test/two-rooms.toml", "test/divider.toml"}) {
    const World world(name);
    const VplTable vpls = keptVpls(world, {{"count", "500"}}, {{"count", "10k"}});
    const EstimateResult result = lightVpls(world, vpls, {{"photons", "300k"}});
    EXPECT_GT(result.energy.reflected, 0.0);
    EXPECT_EQ(totalFlux(result.table), 0.0) << name;
  }
}

}  // namespace
}  // namespace bnvpl::test
