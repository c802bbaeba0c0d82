#include "tests/support/gather_checks.h"

namespace bnvpl::test {
namespace {

// The method is unbiased: the tolerance is three standard errors of these few samples.
TEST(Stochastic, HasTheEnergyOfAllVpls) { expectEnergyOfAll("stochastic", 0.015, 8); }

TEST(Stochastic, WithACutOfOneToo) { expectEnergyOfAll("stochastic", 0.06, 8, {{"cut", "1"}}); }

TEST(Stochastic, IsTheSameForAnyThreads) { expectSameBytesForAnyThreads("stochastic"); }

// A cut of all VPLs has no variance.
TEST(Stochastic, ACutOfAllIsTheSumOverAll) {
  const GatherCase& c = *gatherCases().front();
  const Image all = c.indirect("all", {}, 1), cut = c.indirect("stochastic", {{"cut", "1M"}}, 1);
  const auto &x = *all.find("G"), &y = *cut.find("G");
  for (size_t i = 0; i < x.size(); ++i) ASSERT_NEAR(y[i], x[i], 1e-4f * (x[i] + 1e-3f)) << i;
}

TEST(Stochastic, SendsAtMostOneRayForEachCluster) {
  const Image image =
      gatherCases().front()->indirect("stochastic", {{"layers", "shadowrays"}, {"cut", "7"}}, 1);
  for (const float rays : *image.find("shadowrays")) EXPECT_LE(rays, 7.0f);
}

}  // namespace
}  // namespace bnvpl::test
