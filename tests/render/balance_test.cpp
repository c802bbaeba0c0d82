// Work by a price: where it goes, and that the mean stays.
#include "tools/render/tile/balance.h"

#include <gtest/gtest.h>

#include "tests/support/pipeline.h"

namespace bnvpl::test {
namespace {

TEST(Balance, DrawsGoWithTheirDeviationAndTheRootOfTheirCost) {
  EXPECT_EQ(drawsWorth(4.0, 1.0, 0.01, 1, 1000), 20u);
  EXPECT_EQ(drawsWorth(16.0, 1.0, 0.01, 1, 1000), 40u);
  EXPECT_EQ(drawsWorth(4.0, 4.0, 0.01, 1, 1000), 10u);
  EXPECT_EQ(drawsWorth(4.0, 1.0, 0.01, 1, 7), 7u);
  EXPECT_EQ(drawsWorth(0.0, 1.0, 0.01, 3, 7), 3u);
}

// What a pixel has found counts for those of the other colour alone.
TEST(Balance, APixelHasNoSayInItsOwnDraws) {
  const TileSlots tile{64, 8};
  const Balance balance{0.01, 0.0, 1e6};
  std::vector<PixelDraws> pixels(64);
  for (PixelDraws& p : pixels) {
    p.add(Vec3(1.0f)), p.add(Vec3(1.2f));
    p.light = Vec3(1.1f);
  }
  const auto worth = [&] { return worthByColour(pixels, tile, 0.01, balance, 1, 1000); };
  const auto before = worth();
  pixels[27].add(Vec3(40.0f));  // of colour 0
  EXPECT_EQ(worth()[0], before[0]);
  EXPECT_GT(worth()[1], 2 * before[1]);
}

// Twice the light of a dark tile takes a quarter of the variance, and half where it is bright.
TEST(Balance, VarianceIsRelativeAndHalfWayToAbsoluteInBrightTiles) {
  const Balance balance{0.01, 0.0, 3.0};
  EXPECT_DOUBLE_EQ(balance.over(1.0, Vec3(0.25f)), 4.0 * balance.over(1.0, Vec3(0.5f)));
  EXPECT_DOUBLE_EQ(balance.over(1.0, Vec3(2.0f)), 2.0 * balance.over(1.0, Vec3(4.0f)));
  EXPECT_EQ(Balance{}.over(1.0, Vec3{}), 0.0);
}

// Light through a door, and direct light of a lamp that is hidden from most of the film.
TEST(Balance, ImagesKeepTheirMean) {
  World world("veach-door/scene.toml");
  world.scene.film = {48, 27};
  const VplTable lit = litVpls(world, {{"count", "600"}});
  double off = 0.0, on = 0.0;
  for (uint64_t seed = 1; seed <= 6; ++seed) {
    const Given options{{"spp", "8"}, {"seed", typed(seed)}};
    const auto meanWith = [&](const char* balance) {
      const FilmStats s = renderVpls(world, lit, with(options, {{"balance", balance}})).stats;
      return s.direct + s.indirect;
    };
    off += meanWith("off"), on += meanWith("on");
  }
  EXPECT_NEAR(on / off, 1.0, 0.01);
}

}  // namespace
}  // namespace bnvpl::test
