#include "tests/support/gather_checks.h"

namespace bnvpl::test {
namespace {

// Squared difference from the sum over all VPLs at the same points, over the squared mean.
double errorOf(const GatherCase& c, const Given& options) {
  const Image all = c.indirect("all"), image = c.indirect("mrcs", options);
  double squared = 0.0;
  for (size_t i = 0; i < all.pixelCount(); ++i) {
    const double difference = double{(*image.find("G"))[i]} - double{(*all.find("G"))[i]};
    squared += difference * difference;
  }
  const double sum = meanOf(all);
  return squared / (static_cast<double>(all.pixelCount()) * sum * sum);
}

TEST(Mrcs, HasTheEnergyOfAllVpls) {
  expectEnergyOfAll("mrcs", 0.02, 3, {{"rows", "100"}, {"columns", "200"}});
}

// VPLs that no row sees must not be lost: with two rows most are.
TEST(Mrcs, HasTheEnergyOfAllVplsWithHardlyAnyRows) {
  const GatherCase& c = *gatherCases().front();
  double sum = 0.0, all = 0.0;
  for (uint64_t seed = 1; seed <= 24; ++seed) {
    sum += meanOf(c.indirect("mrcs", {{"rows", "2"}, {"columns", "300"}}, seed));
    all += meanOf(c.indirect("all", {}, seed));
  }
  EXPECT_NEAR(sum / all, 1.0, 0.05);
}

TEST(Mrcs, AsManyColumnsAsVplsAreAllVpls) {
  for (const GatherCase* c : gatherCases()) EXPECT_LT(errorOf(*c, {{"columns", "100k"}}), 1e-9);
}

TEST(Mrcs, IsTheSameForAnyThreads) { expectSameBytesForAnyThreads("mrcs"); }

TEST(Mrcs, MoreColumnsAreNearerToAllVpls) {
  const GatherCase& c = *gatherCases().back();
  double before = INFINITY;
  for (const char* columns : {"20", "100", "900"}) {
    const double error = errorOf(c, {{"columns", columns}});
    EXPECT_LT(error, before) << columns;
    before = error;
  }
}

}  // namespace
}  // namespace bnvpl::test
