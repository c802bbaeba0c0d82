#include "tests/support/gather_checks.h"

namespace bnvpl::test {
namespace {

double gridLights(const Given& options) {
  return meanOfLayer(gatherCases().front()->indirect("grid-hierarchy",
                                                     with({{"layers", "gridlights"}}, options), 1),
                     "gridlights");
}

// Lights of grids are means: the bias is that of positions and normals, and has no bound.
TEST(GridHierarchy, HasAboutTheEnergyOfAllVpls) {
  expectEnergyOfAll("grid-hierarchy", 0.06, 2);
  expectEnergyInFurnaceAndOfOneBounce("grid-hierarchy", 0.05);
}

TEST(GridHierarchy, WithNearVplsEverywhereIsTheSumOverAll) {
  expectSumOverAll("grid-hierarchy", {{"alpha", "1000000"}});
  EXPECT_EQ(gridLights({{"alpha", "1000000"}}), 0.0);
}

TEST(GridHierarchy, NearerGridsHaveMoreBias) {
  const GatherCase& c = *gatherCases().front();
  const Image all = c.indirect("all", {}, 1);
  const auto error = [&](const char* alpha) {
    const Image own = c.indirect("grid-hierarchy", {{"alpha", alpha}}, 1);
    double sum = 0.0;
    for (size_t i = 0; i < all.pixelCount(); ++i)
      sum += std::abs(double{(*own.find("G"))[i]} - double{(*all.find("G"))[i]});
    return sum;
  };
  EXPECT_LT(error("4"), 0.7 * error("1"));
  EXPECT_GT(gridLights({}), 0.0);
}

}  // namespace
}  // namespace bnvpl::test
