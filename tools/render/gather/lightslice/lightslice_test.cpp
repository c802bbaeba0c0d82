#include "tests/support/gather_checks.h"

namespace bnvpl::test {
namespace {

double sliceError(const GatherCase& c, const Given& options) {
  return relativeMseToAll(c, "lightslice", options);
}

TEST(LightSlice, HasTheMeanOfAllVpls) {
  expectMeanOfAll("lightslice", 0.02, {{"slices", "60"}, {"columns", "150"}});
}

TEST(LightSlice, HasTheEnergyInFurnaceAndOfOneBounce) {
  expectEnergyInFurnaceAndOfOneBounce("lightslice", 0.02);
}

TEST(LightSlice, MoreColumnsAreNearerToAllVpls) {
  const GatherCase& c = *gatherCases().back();
  double before = INFINITY;
  for (const char* columns : {"20", "100", "400"}) {
    const double error = sliceError(c, {{"columns", columns}});
    EXPECT_LT(error, before) << columns;
    before = error;
  }
}

// Clusters per slice are better than as many for all points (Ou & Pellacini 2011).
TEST(LightSlice, SlicesAreBetterThanOneForAll) {
  for (const GatherCase* c : gatherCases()) {
    const double slices = sliceError(*c, {{"columns", "100"}});
    EXPECT_LT(slices, 0.1 * sliceError(*c, {{"columns", "100"}, {"slices", "1"}}));
  }
}

TEST(LightSlice, WithAColumnForEveryVplItIsAll) {
  expectSumOverAll("lightslice", {{"columns", "1M"}, {"slices", "20"}}, {{"spp", "1"}});
}

// A VPL that the points of all slices miss still lights the others: with one slice, most of those
// behind the door are such VPLs.
TEST(LightSlice, VplsThatNoSliceSeesAreNotLost) {
  const Given one{{"slices", "1"}, {"columns", "50"}, {"spp", "16"}};
  expectMeanOfAll("lightslice", 0.1, one, false, 24);
}

}  // namespace
}  // namespace bnvpl::test
