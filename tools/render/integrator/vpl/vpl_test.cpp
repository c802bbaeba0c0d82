#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/pipeline.h"

namespace bnvpl::test {
namespace {

TEST(Clamp, WhatItRemovesIsReportedAndGivesTheUnclampedImage) {
  World world("furnace/scene.toml");
  world.scene.film = {24, 24};
  const VplTable lit = litVpls(world, {{"count", "300"}});
  const auto clampedAt = [&](const char* clamp) {
    return renderVpls(world, lit, with(kPlainRender, {{"clamp", clamp}})).stats;
  };
  const FilmStats loose = clampedAt("0.02"), tight = clampedAt("4");
  EXPECT_LT(tight.indirect, 0.95 * loose.indirect);
  EXPECT_NEAR(tight.indirect + tight.clamped, loose.indirect + loose.clamped,
              0.001 * loose.indirect);
}

TEST(Vpl, CountsVplsApartFromThePlacesFromWhichTheyShine) {
  const World world("furnace/scene.toml");
  const VplTable candidates = placeVpls(world, kFewCandidates).table;
  const VplTable vpls = keepVpls(candidates, {{"count", "100"}});
  const auto lit = [&](const char* points) {
    return lightVpls(world, vpls, with(kFewPhotons, {{"emit-points", points}})).table;
  };
  const VplTable four = lit("4");
  const auto withFlux =
      static_cast<size_t>(std::ranges::count_if(four.flux, [](Vec3 f) { return mean(f) > 0.0f; }));
  const RenderResult image = renderVpls(world, four, kPlainRender);
  EXPECT_EQ(image.vpls, withFlux);
  EXPECT_GT(image.emissionPoints, 2 * withFlux);
  EXPECT_LE(image.emissionPoints, 4 * withFlux);
  const RenderResult sites = renderVpls(world, lit("0"), kPlainRender);
  EXPECT_EQ(sites.emissionPoints, sites.vpls);
}

}  // namespace
}  // namespace bnvpl::test
