#include "tests/support/gather_checks.h"

namespace bnvpl::test {
namespace {

double counted(const std::string& layer, const Given& options) {
  return meanOfLayer(
      gatherCases().front()->indirect("adaptive-tree", with({{"layers", layer}}, options), 1),
      layer);
}

TEST(AdaptiveTree, HasTheMeanOfAllVpls) {
  expectMeanOfAll("adaptive-tree", 0.01);
  expectEnergyInFurnaceAndOfOneBounce("adaptive-tree", 0.015);
}

TEST(AdaptiveTree, WithASingleDrawToo) {
  expectMeanOfAll("adaptive-tree", 0.15, {{"split", "0"}}, false);
  EXPECT_EQ(counted("treesplits", {{"split", "0"}}), 0.0);
}

TEST(AdaptiveTree, SplitToSingleVplsItIsTheSumOverAll) {
  expectSumOverAll("adaptive-tree", {{"split", "1"}});
  EXPECT_EQ(counted("importances", {{"split", "1"}}), 0.0);
}

TEST(AdaptiveTree, AHigherQualitySplitsMore) {
  EXPECT_GT(counted("treesplits", {{"split", "0.97"}}),
            1.5 * counted("treesplits", {{"split", "0.9"}}));
}

}  // namespace
}  // namespace bnvpl::test
