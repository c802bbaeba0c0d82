#include <gtest/gtest.h>

#include "tests/support/gather_checks.h"

namespace bnvpl::test {
namespace {

const GatherCase& lit() {
  static const GatherCase c("cornell/scene.toml", {40, 40}, {{"count", "2000"}});
  return c;
}

Image render(const std::string& gather, const Given& options = {}) {
  return lit().indirect(gather, with({{"spp", "1"}, {"layers", "cutsize"}}, options));
}

double relativeDifference(const Image& a, const Image& b) {
  double difference = 0.0, sum = 0.0;
  for (const char* c : {"R", "G", "B"}) {
    const auto &x = *a.find(c), &y = *b.find(c);
    for (size_t i = 0; i < x.size(); ++i) {
      difference += std::fabs(double{x[i]} - double{y[i]});
      sum += double{y[i]};
    }
  }
  return difference / sum;
}

TEST(Lightcuts, HasTheEnergyInFurnaceAndOfOneBounce) {
  expectEnergyInFurnaceAndOfOneBounce("lightcuts", 0.02);
}

TEST(Lightcuts, WithoutToleratedErrorIsTheSumOverAll) {
  const Image all = render("all");
  const Image cuts = render("lightcuts", {{"error", "0"}, {"max-cut", "1M"}});
  const auto &x = *all.find("R"), &y = *cuts.find("R");
  for (size_t i = 0; i < x.size(); ++i) ASSERT_NEAR(y[i], x[i], 1e-5f * (x[i] + 1e-3f)) << i;
}

TEST(Lightcuts, AtTwoPercentStaysNearTwoPercent) {
  const Image all = render("all");
  const Image cuts = render("lightcuts");
  EXPECT_LT(relativeDifference(cuts, all), 0.02);
  EXPECT_GT(relativeDifference(cuts, all), 0.0);  // cuts are smaller than the set of VPLs
}

TEST(Lightcuts, TheCutIsBounded) {
  const Image cuts = render("lightcuts", {{"error", "0"}, {"max-cut", "100"}});
  for (const float c : *cuts.find("cutsize")) EXPECT_LE(c, 100.0f);
  const Image loose = render("lightcuts", {{"error", "0.2"}});
  double mean = 0.0;
  for (const float c : *loose.find("cutsize")) mean += double{c} / double(loose.pixelCount());
  EXPECT_LT(mean, 500.0);
}

}  // namespace
}  // namespace bnvpl::test
