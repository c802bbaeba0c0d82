#include "tests/support/gather_checks.h"

namespace bnvpl::test {
namespace {

TEST(Mrcs, HasTheMeanOfAllVpls) {
  expectMeanOfAll("mrcs", 0.02, {{"rows", "100"}, {"columns", "200"}}, true, 24);
}

TEST(Mrcs, HasTheEnergyInFurnaceAndOfOneBounce) {
  expectEnergyInFurnaceAndOfOneBounce("mrcs", 0.02);
}

// VPLs that no row sees must not be lost: with two rows most are.
TEST(Mrcs, HasTheEnergyOfAllVplsWithHardlyAnyRows) {
  const GatherCase& c = *gatherCases().front();
  double sum = 0.0, all = 0.0;
  for (uint64_t seed = 1; seed <= 12; ++seed) {
    sum += meanOf(c.indirect("mrcs", {{"rows", "2"}, {"columns", "300"}}, seed));
    all += meanOf(c.ofAll({{"light", "point"}}, seed));
  }
  EXPECT_NEAR(sum / all, 1.0, 0.05);
}

TEST(Mrcs, WithAsManyColumnsAsVplsItIsTheSumOverAll) {
  expectSumOverAll("mrcs", {{"columns", "100k"}});
}

TEST(Mrcs, MoreColumnsAreNearerToAllVpls) {
  const GatherCase& c = *gatherCases().back();
  double before = INFINITY;
  for (const char* columns : {"20", "100", "900"}) {
    const double error = relativeMseToAll(c, "mrcs", {{"columns", columns}});
    EXPECT_LT(error, before) << columns;
    before = error;
  }
}

}  // namespace
}  // namespace bnvpl::test
