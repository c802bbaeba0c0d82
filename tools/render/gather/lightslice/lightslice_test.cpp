#include "tests/support/gather_checks.h"

namespace bnvpl::test {
namespace {

double sliceError(const GatherCase& c, const Given& options) {
  return relativeMseToAll(c, "lightslice", options);
}

// VPLs that no slice's representative sees are lost (theory.md).
TEST(LightSlice, HasTheEnergyOfAllVpls) { expectEnergyOfAll("lightslice", 0.03, 2); }

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

// Clusters of one VPL are exact; larger clusters hold VPLs whose columns have one direction.
TEST(LightSlice, WithoutALimitToColumnsItIsNearlyAll) {
  for (const GatherCase* c : gatherCases()) {
    EXPECT_LT(sliceError(*c, {{"columns", "1M"}}), 0.1 * sliceError(*c, {{"columns", "60"}}));
  }
}

}  // namespace
}  // namespace bnvpl::test
