#include <gtest/gtest.h>

#include "tests/support/pipeline.h"
#include "tests/support/threads.h"

namespace bnvpl::test {
namespace {

struct FromLights {
  FromLights() : world("cornell/scene.toml") {
    world.scene.film = {32, 24};
    all = placeVpls(world, {{"count", "4000"}, {"method", "light"}}).table;
  }
  VplTable keep(const Given& options) const {
    const Given given = with({{"count", "400"}, {"method", "rejection"}}, options);
    return eliminate(all, resolve(eliminateSpec(), given), &world.accel, &world.lights);
  }
  double light(const VplTable& vpls) const {
    const Given plain = with(kPlainRender, {{"only", "indirect"}, {"clamp", "0.01"}, {"spp", "1"}});
    return meanOf(renderVpls(world, vpls, plain).image);
  }
  World world;
  VplTable all;
};
const FromLights& cornell() {
  static const FromLights one;
  return one;
}

// A kept VPL is scaled by one over its probability, so the expected image is that of all VPLs.
TEST(Rejection, KeepsTheEnergyOnAverage) {
  const auto& c = cornell();
  // Nothing is clamped, because the clamp scales with r_max, which grows as fewer VPLs are kept.
  double sum = 0.0;
  constexpr int kSeeds = 12;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const VplTable kept = c.keep({{"seed", std::to_string(seed)}});
    sum += c.light(kept) / kSeeds;
  }
  EXPECT_NEAR(sum / c.light(c.all), 1.0, 0.04);
}

TEST(Rejection, KeepsAboutTheCount) {
  double sum = 0.0;
  for (int seed = 1; seed <= 8; ++seed) {
    const VplTable kept = cornell().keep({{"seed", std::to_string(seed)}});
    EXPECT_EQ(kept.stage, VplStage::Lit);
    EXPECT_EQ(kept.radius.size(), kept.size());
    sum += double(kept.size()) / 8;
  }
  EXPECT_NEAR(sum, 400.0, 3.0 * 20.0 / std::sqrt(8.0));  // the variance of a count is at most 400
}

TEST(Rejection, ThatKeepsNoneIsRefused) {
  int refused = 0;
  for (int seed = 1; seed <= 12; ++seed) {
    try {
      const Given one{{"count", "1"}, {"min-probability", "1e-6"}, {"seed", std::to_string(seed)}};
      EXPECT_GT(cornell().keep(one).size(), 0u);
    } catch (const InputError& e) {
      EXPECT_STREQ(e.what(), "--method rejection kept no VPL; raise -n, or change --seed");
      ++refused;
    }
  }
  EXPECT_GT(refused, 0);
}

// The share of all of the view's light is then more than one VPL.
TEST(Rejection, TakesOne) {
  size_t kept = 0;
  for (int seed = 1; seed <= 8; ++seed) {
    try {
      kept +=
          cornell()
              .keep({{"count", "1"}, {"min-probability", "1e-6"}, {"seed", std::to_string(seed)}})
              .size();
    } catch (const InputError& e) {
      EXPECT_STREQ(e.what(), "--method rejection kept no VPL; raise -n, or change --seed");
    }
  }
  EXPECT_GT(kept, 0u);
}

// A VPL without contribution to the view is kept with probability 1/100 and 100 times its flux.
TEST(Rejection, WeighsByOneOverTheProbability) {
  const VplTable& all = cornell().all;
  const VplTable kept = cornell().keep({});
  double largest = 0.0;
  for (size_t i = 0; i < kept.size(); ++i) {
    const double weight = double{mean(kept.flux[i]) / mean(all.flux[kept.id[i]])};
    EXPECT_GE(weight, 0.999);
    largest = std::max(largest, weight);
    EXPECT_EQ(kept.position[i], all.position[kept.id[i]]);
  }
  EXPECT_LE(largest, 100.1);
}

TEST(Rejection, IsTheSameForAnyThreads) {
  std::vector<VplTable> tables;
  for (const size_t threads : {1u, 5u})
    tables.push_back(withThreads(threads, [] { return cornell().keep({}); }));
  EXPECT_EQ(tables[0].id, tables[1].id);
  EXPECT_EQ(tables[0].flux, tables[1].flux);
}

TEST(Rejection, ReportsItsPreparations) {
  const FromLights& c = cornell();
  Preparations told;
  const Values options = resolve(eliminateSpec(), {{"count", "200"}, {"method", "rejection"}});
  eliminate(c.all, options, &c.world.accel, &c.world.lights, told.progress);
  EXPECT_EQ(told.names, std::vector<std::string>{"camera points"});
}

TEST(Rejection, AsksForTheScene) {
  const Values options = resolve(eliminateSpec(), {{"count", "10"}, {"method", "rejection"}});
  EXPECT_THROW(eliminate(cornell().all, options), UsageError);
}

}  // namespace
}  // namespace bnvpl::test
