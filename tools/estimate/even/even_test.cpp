#include <gtest/gtest.h>

#include "tests/support/pipeline.h"

namespace bnvpl::test {
namespace {

// As the thesis says, and where the guarded method must not: its test would be empty if nothing
// could leak there.
TEST(Even, LeaksUnderTheDivider) {
  const World world("test/divider.toml");
  const VplTable vpls = keptVpls(world, {{"count", "500"}}, {{"count", "10k"}});
  EXPECT_GT(totalFlux(lightVpls(world, vpls, {{"photons", "100k"}, {"method", "even"}}).table),
            0.0);
}

}  // namespace
}  // namespace bnvpl::test
