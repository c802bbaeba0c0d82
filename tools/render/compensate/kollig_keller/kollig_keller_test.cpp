#include <gtest/gtest.h>

#include <map>

#include "tests/support/mean_test.h"
#include "tests/support/pipeline.h"

namespace bnvpl::test {
namespace {

// A scene with its indirect light by paths, and sets of VPLs from its lights by seed.
class Sets {
 public:
  Sets(const std::string& name, Film film, const char* spp) : world_(name) {
    world_.scene.film = film;
    path_ = indirectByPaths(world_, {{"spp", spp}});
  }
  // Indirect light by the VPLs of a seed over that by paths.
  double ratio(uint64_t seed, const Given& options) const {
    const auto [set, isNew] = sets_.try_emplace(seed);
    if (isNew) {
      const Given placed{{"method", "light"}, {"count", "2000"}, {"seed", typed(seed)}};
      set->second = placeVpls(world_, placed).table;
    }
    return indirectByVpls(world_, set->second,
                          with({{"spp", "1"}, {"seed", typed(seed)}}, options)) /
           path_;
  }
  double meanRatio(const Given& options) const {
    double sum = 0.0;
    for (uint64_t seed = 1; seed <= kSets; ++seed) sum += ratio(seed, options);
    return sum / kSets;
  }
  // The slack is the error of the image by paths.
  testing::AssertionResult unbiased(const Given& options) const {
    const auto errorOf = [&](uint64_t seed) { return ratio(seed, options) - 1.0; };
    return hasMeanZero(errorOf, kSets, 0.02, 0.003);
  }

 private:
  static constexpr uint64_t kSets = 12;
  World world_;
  double path_ = 0.0;
  mutable std::map<uint64_t, VplTable> sets_;
};
const Given kUncompensated{{"compensate", "none"}, {"clamp", "8"}};

// The bound moves light between VPLs and rays, and its mean over sets of VPLs stays that of paths.
TEST(KolligKeller, IsUnbiasedWhateverTheBound) {
  const Sets sets("cornell/scene.toml", {16, 16}, "2048");
  const std::vector<std::pair<const char*, const char*>> bounds{
      {"point", "0.5"}, {"point", "2"}, {"point", "8"}, {"disk", "2"}, {"yuksel", "2"}};
  for (const auto& [light, clamp] : bounds) {
    EXPECT_TRUE(
        sets.unbiased({{"compensate", "kollig-keller"}, {"clamp", clamp}, {"light", light}}))
        << light << clamp;
  }
  EXPECT_LT(sets.meanRatio(kUncompensated), 0.9);
}

// In the furnace every surface has the same light; the other scene has one bounce between two
// patches.
TEST(KolligKeller, KeepsTheEnergy) {
  for (const char* name : {"furnace/scene.toml", "test/one-bounce.toml"}) {
    const Sets sets(name, {16, 12}, "1024");
    const Given ours{{"compensate", "kollig-keller"}, {"clamp", "8"}};
    EXPECT_TRUE(sets.unbiased(ours)) << name;
    EXPECT_LT(sets.meanRatio(kUncompensated), 0.98 * sets.meanRatio(ours)) << name;
  }
}

// Paths go on where the bound removes light, from more vertices if it removes more.
TEST(KolligKeller, CountsTheRaysThatGoOn) {
  World world("cornell/scene.toml");
  world.scene.film = {16, 16};
  const VplTable lit = placeVpls(world, {{"method", "light"}, {"count", "200"}}).table;
  const auto continued = [&](const char* clamp) {
    const Given options{{"compensate", "kollig-keller"}, {"clamp", clamp}, {"only", "indirect"}};
    return renderVpls(world, lit, with(kPlainRender, options)).stats.own[0];
  };
  EXPECT_EQ(continued("0"), 0.0);
  EXPECT_GT(continued("1"), 0.0);
  EXPECT_GT(continued("4"), 4.0 * continued("1"));
}

TEST(KolligKeller, AllVplsHaveOneSize) {
  World world("cornell/scene.toml");
  world.scene.film = {16, 16};
  VplTable lit = litVpls(world, {{"count", "200"}}, {{"photons", "50k"}}, {{"count", "4k"}});
  const auto shown = [&](const char* compensate) {
    return indirectByVpls(world, lit, {{"compensate", compensate}, {"clamp", "6"}});
  };
  const double before = shown("kollig-keller"), none = shown("none");
  // The mean area is the same, but each VPL's own is not.
  for (size_t i = 0; i + 1 < lit.size(); i += 2) {
    const float r2 = lit.radius[i] * lit.radius[i] + lit.radius[i + 1] * lit.radius[i + 1];
    lit.radius[i] = std::sqrt(0.1f * r2), lit.radius[i + 1] = std::sqrt(0.9f * r2);
  }
  const double ours = std::fabs(shown("kollig-keller") / before - 1.0);
  EXPECT_LT(ours, 2e-3);  // light sampling at vertices asks for the radii, too
  EXPECT_GT(std::fabs(shown("none") / none - 1.0), 4.0 * ours);
}

}  // namespace
}  // namespace bnvpl::test
