#include "tests/support/gather_checks.h"

namespace bnvpl::test {
namespace {

// Squared difference to the sum over all VPLs at the same points, summed over the pixels.
double errorOf(const GatherCase& c, const Given& options) {
  const Image all = c.indirect("all"), image = c.indirect("lightslice", options);
  double squared = 0.0;
  for (size_t i = 0; i < all.pixelCount(); ++i) {
    const double difference = double{(*image.find("G"))[i]} - double{(*all.find("G"))[i]};
    squared += difference * difference;
  }
  return squared;
}

// VPLs that are invisible from the representatives of all slices are lost (theory.md).
TEST(LightSlice, HasTheEnergyOfAllVpls) { expectEnergyOfAll("lightslice", 0.03, 2); }

TEST(LightSlice, IsTheSameForAnyThreads) { expectSameBytesForAnyThreads("lightslice"); }

TEST(LightSlice, MoreColumnsAreNearerToAllVpls) {
  const GatherCase& c = *gatherCases().back();
  double before = INFINITY;
  for (const char* columns : {"20", "100", "400"}) {
    const double error = errorOf(c, {{"columns", columns}});
    EXPECT_LT(error, before) << columns;
    before = error;
  }
}

// Ou & Pellacini 2011: clusters for each slice are better than the same number for all points.
TEST(LightSlice, SlicesAreBetterThanOneForAll) {
  for (const GatherCase* c : gatherCases()) {
    const double slices = errorOf(*c, {{"columns", "100"}});
    EXPECT_LT(slices, 0.1 * errorOf(*c, {{"columns", "100"}, {"slices", "1"}}));
  }
}

// Clusters of a single VPL are exact, and the columns of larger ones are parallel.
TEST(LightSlice, WithoutALimitToColumnsItIsNearlyAll) {
  for (const GatherCase* c : gatherCases()) {
    EXPECT_LT(errorOf(*c, {{"columns", "1M"}}), 0.1 * errorOf(*c, {{"columns", "60"}}));
  }
}

}  // namespace
}  // namespace bnvpl::test
