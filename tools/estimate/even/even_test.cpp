#include <gtest/gtest.h>

#include "tests/support/pipeline.h"

namespace bnvpl::test {
namespace {

// Light leaks here as the thesis describes. The guarded method must not leak in this scene; this
// test shows that it could.
TEST(Even, LeaksUnderTheDivider) {
  const World world("test/divider.toml");
  const VplTable vpls = keptVpls(world, {{"count", "500"}}, {{"count", "10k"}});
  EXPECT_GT(totalFlux(lightVpls(world, vpls, {{"photons", "100k"}, {"method", "even"}}).table),
            0.0);
}

}  // namespace
}  // namespace bnvpl::test
