#include "tests/support/gather_checks.h"

namespace bnvpl::test {
namespace {

// Untested VPLs count with an expected visibility, which is right on average up to its own error.
TEST(Ward, HasTheEnergyOfAllVpls) { expectEnergyOfAll("ward", 0.02, 1); }

TEST(Ward, HasTheEnergyInFurnaceAndOfOneBounce) {
  expectEnergyInFurnaceAndOfOneBounce("ward", 0.02);
}

TEST(Ward, WithoutToleranceEveryVplIsTested) {
  const GatherCase& c = *gatherCases().front();
  const Image all = c.indirect("all", {}, 1), ward = c.indirect("ward", {{"tolerance", "0"}}, 1);
  const auto &x = *all.find("G"), &y = *ward.find("G");
  for (size_t i = 0; i < x.size(); ++i) ASSERT_NEAR(y[i], x[i], 1e-5f * (x[i] + 1e-3f)) << i;
}

// Most of the shadow rays are saved at a small error (Ward 1994).
TEST(Ward, SavesShadowRays) {
  const GatherCase& c = *gatherCases().front();
  const auto rays = [&](const std::string& gather) {
    const Image image = c.indirect(gather, {{"layers", "shadowrays"}}, 1);
    double sum = 0.0;
    for (const float r : *image.find("shadowrays")) sum += double{r};
    return sum;
  };
  EXPECT_LT(rays("ward"), 0.6 * rays("all"));
}

TEST(Ward, ReportsItsPreparations) {
  const GatherCase& c = *gatherCases().front();
  Preparations told;
  const Values options =
      resolve(renderSpec(), with(kPlainRender, {{"gather", "ward"}, {"only", "indirect"}}));
  render(c.world.accel, c.world.lights, c.lit, options, told.progress);
  EXPECT_EQ(told.names, std::vector<std::string>{"visibility pilot, VPLs"});
}

}  // namespace
}  // namespace bnvpl::test
