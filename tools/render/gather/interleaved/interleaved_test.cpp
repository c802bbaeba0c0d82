#include <gtest/gtest.h>

#include "tests/support/gather_checks.h"
#include "tests/transport/plain_scene.h"

namespace bnvpl::test {
namespace {

double differenceOf(const Image& a, const Image& b) {
  double difference = 0.0, sum = 0.0;
  for (size_t i = 0; i < a.pixelCount(); ++i) {
    difference += std::fabs(double{(*a.find("G"))[i]} - double{(*b.find("G"))[i]});
    sum += double{(*b.find("G"))[i]};
  }
  return difference / sum;
}

TEST(Interleaved, HasTheEnergyOfAllVpls) { expectEnergyOfAll("interleaved", 0.02, 2); }

TEST(Interleaved, HasTheEnergyInFurnaceAndOfOneBounce) {
  expectEnergyInFurnaceAndOfOneBounce("interleaved", 0.02);
}

TEST(Interleaved, PatternsOfOnePixelAreTheSumOverAll) {
  for (const GatherCase* c : gatherCases()) {
    const Image all = c->indirect("all"), one = c->indirect("interleaved", {{"interleave", "1"}});
    for (size_t i = 0; i < all.pixelCount(); ++i)
      ASSERT_NEAR((*one.find("R"))[i], (*all.find("R"))[i], 1e-5f * (*all.find("R"))[i] + 1e-8f);
  }
}

// Nine samples of a pixel take turns with its nine subsets. Without the filter's neighbours, at
// pixels that see several surfaces, the sum of a pixel still holds every VPL once.
TEST(Interleaved, SamplesOfAPixelTakeTurns) {
  const GatherCase& c = *gatherCases().front();
  const double one =
      differenceOf(c.indirect("interleaved", {{"spp", "1"}}), c.indirect("all", {{"spp", "1"}}));
  const double nine =
      differenceOf(c.indirect("interleaved", {{"spp", "9"}}), c.indirect("all", {{"spp", "9"}}));
  EXPECT_LT(nine, 0.5 * one);
}

// A floor below a wall that lights it, seen from above: the whole film shows one plane. Its mean
// stays that of all VPLs whichever pixels hold which subsets, also where the film ends.
Scene litPlane() {
  Scene scene = floorAndWallBelowLamp({31, 22});
  finishScene(scene);
  return scene;
}

TEST(Interleaved, TheFilterKeepsTheEnergyOfAPlane) {
  const World world{litPlane()};
  const VplTable lit = litVpls(world, {{"count", "400"}}, {{"photons", "50k"}}, {{"count", "4k"}});
  const auto shown = [&](const char* gather, const Given& options) {
    return renderVpls(world, lit,
                      with(with(kPlainRender, {{"gather", gather}, {"spp", "1"}}), options));
  };
  const RenderResult all = shown("all", {});
  for (const char* side : {"3", "5"}) {
    const RenderResult ours = shown("interleaved", {{"interleave", side}});
    EXPECT_NEAR(ours.stats.indirect / all.stats.indirect, 1.0, 0.003) << side;
    EXPECT_EQ(ours.stats.own[0], std::stod(side) * std::stod(side));
    EXPECT_LT(differenceOf(ours.image, all.image), 0.02) << side;
    // The pattern shifts with each pass, for all tiles alike.
    const Given passes{{"passes", "2"}, {"pass-spp", "1"}, {"spp", "2"}, {"adaptive", "off"}};
    const Image byPasses = shown("interleaved", with({{"interleave", side}}, passes)).image;
    EXPECT_LT(differenceOf(byPasses, shown("all", passes).image), 0.02) << side;
  }
}

// Two pixels of a plane that is white, and one between them that is red. Their subsets sum up to 1,
// 3 and 2; the red pixel knows nothing of green light.
TEST(Interleaved, RedPixelsDarkenNoOtherChannel) {
  std::vector<PixelSums> film(3);
  std::vector<PixelCounts> counts(3);
  for (size_t i = 0; i < film.size(); ++i) {
    PixelSums& p = film[i];
    p.sum[PixelSums::kHits] = 1.0, p.sum[PixelSums::kDepth] = 2.0;
    p.sum[PixelSums::kNormal + 2] = 1.0;
    for (size_t c = 0; c < 3; ++c) {
      p.sum[PixelSums::kAlbedo + c] = i == 1 && c > 0 ? 0.0 : 0.5;
      p.sum[PixelSums::kToFilter + c] = p.sum[PixelSums::kAlbedo + c] * (i == 0   ? 1
                                                                         : i == 1 ? 3
                                                                                  : 2);
    }
  }
  const GatherMethod& method = methodNamed(gatherMethods(), "interleaved");
  const Values options = resolve(renderSpec(), {{"gather", "interleaved"}, {"interleave", "3"}});
  applyFilter(
      method.gatherFilter(options), 3, {0, 0, 3, 1}, [](size_t) { return uint64_t{1}; }, film,
      counts);
  EXPECT_NEAR(film[0].sum[PixelSums::kToFilter], 0.5 * 2.0, 1e-6);
  EXPECT_NEAR(film[0].sum[PixelSums::kToFilter + 1], 0.5 * 1.5, 1e-6);
  EXPECT_EQ(film[1].sum[PixelSums::kToFilter + 1], 0.0);
  EXPECT_NEAR(film[2].sum[PixelSums::kToFilter + 2], 0.5 * 1.5, 1e-6);
}

// A filter that crossed the silhouettes of the blocks would bring the light of the wall behind.
TEST(Interleaved, TheFilterStopsAtDiscontinuities) {
  const GatherCase& c = *gatherCases().front();
  const Given options = with(kPlainRender, {{"gather", "interleaved"}, {"spp", "2"}});
  const RenderResult ours = renderVpls(c.world, c.lit, with(options, {{"layers", "filterpixels"}}));
  EXPECT_LT(ours.stats.own[0], 8.5);
  EXPECT_GT(ours.stats.own[0], 2.5);
  EXPECT_NEAR(meanOfLayer(ours.image, "filterpixels"), ours.stats.own[0], 1e-4);
  const RenderResult passes = renderVpls(
      c.world, c.lit, with(options, {{"passes", "2"}, {"spp", "8"}, {"layers", "filterpixels"}}));
  EXPECT_NEAR(meanOfLayer(passes.image, "filterpixels"), passes.stats.own[0], 1e-4);
  EXPECT_NEAR(passes.stats.own[0], ours.stats.own[0], 0.5);
}

}  // namespace
}  // namespace bnvpl::test
