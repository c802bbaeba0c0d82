#include <gtest/gtest.h>

#include "core/errors.h"
#include "tests/support/gather_checks.h"

namespace bnvpl::test {
namespace {

const Given kExact{{"error", "0"}, {"max-cut", "1M"}};

// Both representatives of a pair are drawn, so that no tree of VPLs leaves a bias of its own. What
// is left comes from the end of refinement by a running total.
TEST(Multidimensional, HasTheEnergyOfAllVpls) { expectEnergyOfAll("multidimensional", 0.005, 2); }

TEST(Multidimensional, HasTheEnergyInFurnaceAndOfOneBounce) {
  expectEnergyInFurnaceAndOfOneBounce("multidimensional", 0.02);
}

// Also with a filter whose lobes make weights of samples negative.
TEST(Multidimensional, WithoutToleratedErrorIsTheSumOverAll) {
  const GatherCase& c = *gatherCases().front();
  for (const char* filter : {"box", "mitchell"}) {
    const Image all = c.indirect("all", {{"filter", filter}, {"control", "none"}});
    const Image ours = c.indirect("multidimensional", with(kExact, {{"filter", filter}}));
    for (const char* channel : {"R", "G", "B"}) {
      const auto &x = *all.find(channel), &y = *ours.find(channel);
      for (size_t i = 0; i < x.size(); ++i)
        ASSERT_NEAR(y[i], x[i], 2e-5f * std::fabs(x[i]) + 1e-6f) << filter << i;
    }
  }
}

double pairsOfPixel(const GatherCase& c, const std::string& gather, const char* spp) {
  const RenderResult image = renderVpls(
      c.world, c.lit, with(kPlainRender, {{"gather", gather}, {"spp", spp}, {"only", "indirect"}}));
  return image.stats.cut * std::stod(spp);
}

// One sample has no others to be split from.
TEST(Multidimensional, CountsSplitsOfSamples) {
  const GatherCase& c = *gatherCases().front();
  const auto splits = [&](const char* spp) {
    const Given options{{"gather", "multidimensional"}, {"spp", spp}, {"only", "indirect"}};
    return renderVpls(c.world, c.lit, with(kPlainRender, options)).stats.own[0];
  };
  EXPECT_EQ(splits("1"), 0.0);
  EXPECT_GT(splits("8"), 0.0);
}

// Pairs of a pixel grow far slower than its samples, and than cuts for each sample.
TEST(Multidimensional, CostGrowsSlowerThanTheNumberOfSamples) {
  const GatherCase& c = *gatherCases().back();
  const double one = pairsOfPixel(c, "multidimensional", "1"),
               many = pairsOfPixel(c, "multidimensional", "32");
  EXPECT_LT(many, 4.0 * one);
  EXPECT_NEAR(pairsOfPixel(c, "lightcuts", "8") / pairsOfPixel(c, "lightcuts", "1"), 8.0, 0.5);
}

TEST(Multidimensional, RefusesWhatNeedsSingleSamples) {
  const Values options = resolveRender({{"gather", "multidimensional"}});
  EXPECT_EQ(options[OptionKey<std::string>{"control"}], "none");
  EXPECT_THROW(resolveRender({{"gather", "multidimensional"}, {"control", "vpls"}}), UsageError);
}

}  // namespace
}  // namespace bnvpl::test
