#include "tests/support/gather_checks.h"
#include "tools/render/gather/lightslice/column_clusters.h"

namespace bnvpl::test {
namespace {

// Clusters are chosen by what the representatives of slices see: VPLs that none of them sees are
// lost (theory.md).
TEST(LightSlice, HasTheEnergyOfAllVpls) { expectEnergyOfAll("lightslice", 0.03, 2); }

TEST(LightSlice, IsTheSameForAnyThreads) { expectSameBytesForAnyThreads("lightslice"); }

TEST(LightSlice, MoreColumnsAreNearerToAllVpls) {
  const GatherCase& c = *gatherCases().back();
  const Image all = c.indirect("all", {}, 1);
  double before = INFINITY;
  for (const char* columns : {"20", "100", "400"}) {
    const Image image = c.indirect("lightslice", {{"columns", columns}}, 1);
    double squared = 0.0;
    for (size_t i = 0; i < all.pixelCount(); ++i) {
      const double difference = double{(*image.find("G"))[i]} - double{(*all.find("G"))[i]};
      squared += difference * difference;
    }
    EXPECT_LT(squared, before) << columns;
    before = squared;
  }
}

// Columns of one direction are one cluster at no cost, whatever their lengths; others are split.
TEST(ColumnClusters, AreOfOneDirection) {
  using namespace methods::gather::lightslice;
  Columns columns;
  columns.rows = 2;
  columns.value = {1, 0, 3, 0, 0, 2, 0, 5, 2, 0};  // lights 0, 1, 4 along x; 2, 3 along y
  columns.measure();
  std::vector<ColumnCluster> clusters{clusterOf({0, 1, 2, 3, 4}, columns)};
  EXPECT_NEAR(clusters[0].cost, 13.0 * 13.0 - 36.0 - 49.0, 1e-9);
  Rng rng(1, 1);
  refine(clusters, 5, columns, rng);
  ASSERT_EQ(clusters.size(), 2u);  // more would cost as much
  for (const ColumnCluster& c : clusters) {
    EXPECT_NEAR(c.cost, 0.0, 1e-9);
    const bool alongX = c.lights.size() == 3;
    const ColumnDraw draw = drawFrom(c, columns, rng);
    EXPECT_NEAR(draw.weight * columns.norm[draw.light], alongX ? 6.0f : 7.0f, 1e-5f);
  }
}

}  // namespace
}  // namespace bnvpl::test
