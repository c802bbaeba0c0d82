#include "tests/support/gather_checks.h"

namespace bnvpl::test {
namespace {

TEST(Stochastic, HasTheMeanOfAllVpls) { expectMeanOfAll("stochastic", 0.01); }

TEST(Stochastic, HasTheEnergyInFurnaceAndOfOneBounce) {
  expectEnergyInFurnaceAndOfOneBounce("stochastic", 0.03);
}

TEST(Stochastic, WithACutOfOneToo) { expectMeanOfAll("stochastic", 0.04, {{"cut", "1"}}); }

// A cut that holds every VPL is deterministic.
TEST(Stochastic, ACutOfAllIsTheSumOverAll) {
  const GatherCase& c = *gatherCases().front();
  const Image all = c.indirect("all", {}, 1), cut = c.indirect("stochastic", {{"cut", "1M"}}, 1);
  const auto &x = *all.find("G"), &y = *cut.find("G");
  for (size_t i = 0; i < x.size(); ++i) ASSERT_NEAR(y[i], x[i], 1e-4f * (x[i] + 1e-3f)) << i;
}

TEST(Stochastic, SendsAtMostOneRayForEachCluster) {
  const Image image =
      gatherCases().front()->indirect("stochastic", {{"layers", "shadowrays"}, {"cut", "7"}}, 1);
  for (const float accel : *image.find("shadowrays")) EXPECT_LE(accel, 7.0f);
}

}  // namespace
}  // namespace bnvpl::test
