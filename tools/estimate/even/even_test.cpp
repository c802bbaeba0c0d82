#include <gtest/gtest.h>

#include "tests/support/pipeline.h"

namespace bnvpl::test {
namespace {

// The method of the thesis leaks in this scene. The test that the guarded method does not leak
// would be void otherwise.
TEST(Even, LeaksUnderTheDivider) {
  const World world("test/divider.toml");
  const VplTable vpls = keptVpls(world, {{"count", "500"}}, {{"count", "10k"}});
  EXPECT_GT(totalFlux(lightVpls(world, vpls, {{"photons", "100k"}, {"method", "even"}}).table),
            0.0);
}

}  // namespace
}  // namespace bnvpl::test
