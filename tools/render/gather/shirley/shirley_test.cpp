#include "tests/support/gather_checks.h"

namespace bnvpl::test {
namespace {

double mean(const std::string& layer, const Given& options) {
  return meanOfLayer(
      gatherCases().front()->indirect("shirley", with({{"layers", layer}}, options), 1), layer);
}

TEST(Shirley, HasTheMeanOfAllVpls) {
  expectMeanOfAll("shirley", 0.01);
  expectEnergyInFurnaceAndOfOneBounce("shirley", 0.03);
}

TEST(Shirley, WithOneDimVplToo) {
  expectMeanOfAll("shirley", 0.08, {{"threshold", "0.01"}, {"dim-rays", "1"}}, false);
}

TEST(Shirley, WhereEveryVplIsBrightItIsTheSumOverAll) {
  expectSumOverAll("shirley", {{"threshold", "0"}});
}

TEST(Shirley, FewerVplsAreBrightThanThereAre) {
  const double bright = mean("brightlights", {});
  EXPECT_GT(bright, 10.0);
  EXPECT_LT(bright, 0.3 * mean("brightlights", {{"threshold", "0"}}));
  EXPECT_LE(mean("shadowrays", {{"dim-rays", "3"}}), bright + 3.0);
}

}  // namespace
}  // namespace bnvpl::test
