#include "tools/place/indirect_share.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/pipeline.h"
#include "tests/support/threads.h"

namespace bnvpl::test {
namespace {

double shareOf(const World& world, uint64_t seed = 1) {
  return indirectShare({world.accel, world.lights, PlaceViews(world.scene)}, seed);
}

// The same by the path tracer: mean over pixels of indirect light / all light.
double shareByPaths(World& world, const char* spp) {
  world.scene.film = {24, 24};
  const auto image = [&](const char* only) {
    return renderWithout(world, "path", {{"only", only}, {"spp", spp}}).image;
  };
  const Image direct = image("direct"), indirect = image("indirect");
  const auto mean3 = [](const Image& of, size_t pixel) {
    double sum = 0.0;
    for (const char* c : {"R", "G", "B"}) sum += double{(*of.find(c))[pixel]};
    return sum;
  };
  double sum = 0.0, lit = 0.0;
  for (size_t p = 0; p < direct.pixelCount(); ++p) {
    const double i = mean3(indirect, p), all = i + mean3(direct, p);
    if (!(all > 0.0)) continue;
    sum += i / all;
    ++lit;
  }
  return sum / lit;
}

// All walls of a closed cube emit E and reflect r = 1/2. Emission and direct light at the walls
// are E + r E, all light is E / (1 - r), so the indirect share is r^2.
TEST(IndirectShare, OfAFurnaceIsTheSquareOfItsAlbedo) {
  EXPECT_NEAR(shareOf(World("furnace/scene.toml")), 0.25, 0.005);
}

// Two black patches send no light back.
TEST(IndirectShare, IsZeroWhereNothingIsReflectedTwice) {
  EXPECT_EQ(shareOf(World("test/two-patches.toml")), 0.0);
}

TEST(IndirectShare, IsOneWithoutLight) {
  Scene scene = loadScene(fs::path(BNVPL_SCENES_DIR) / "furnace/scene.toml");
  for (Material& m : scene.materials) m.emission = {};
  EXPECT_EQ(shareOf(World(std::move(scene))), 1.0);
}

TEST(IndirectShare, IsThatOfThePathTracer) {
  EXPECT_NEAR(shareOf(World("u-shape/scene.toml")), 1.0, 1e-6);
  World box("cornell/scene.toml");
  EXPECT_NEAR(shareOf(box), shareByPaths(box, "64"), 0.04);
  World door("veach-door/scene.toml");
  EXPECT_NEAR(shareOf(door), shareByPaths(door, "64"), 0.03);
}

TEST(IndirectShare, HardlyDependsOnTheSeedAndNotOnThreads) {
  const World world("cornell/scene.toml");
  const double one = shareOf(world);
  EXPECT_NEAR(shareOf(world, 2), one, 0.04);
  for (const size_t threads : {1u, 7u})
    EXPECT_EQ(withThreads(threads, [&] { return shareOf(world); }), one);
}

// The room with the lamp has direct light; of both views, the one without decides.
TEST(IndirectShare, OfSeveralViewsIsTheLargest) {
  const World world("u-shape/scene.toml");
  View left{"", world.scene.camera, {24, 18}}, right = left;
  right.camera.position.x = -right.camera.position.x;
  const auto share = [&](std::vector<View> views) {
    const std::vector<uint64_t> turns(views.size(), 1);
    const PlaceViews of(std::move(views), turns);
    return indirectShare({world.accel, world.lights, of}, 1);
  };
  EXPECT_LT(share({right}), 0.9);
  EXPECT_EQ(share({right, left}), share({left, right}));
  EXPECT_NEAR(share({right, left}), 1.0, 1e-6);
}

// Every stage carries the share from the scene to the light of VPLs.
TEST(IndirectShare, IsCarriedByAllStages) {
  const World world("cornell/scene.toml");
  const VplTable candidates = placeVpls(world, {{"count", "2k"}}).table;
  EXPECT_EQ(candidates.indirectShare, shareOf(world));
  const VplTable kept = keepVpls(candidates, {{"count", "200"}});
  EXPECT_EQ(kept.indirectShare, candidates.indirectShare);
  for (const char* method : {"both", "guarded", "paths", "even"}) {
    const Given options{{"method", method}};
    const Given few = std::string(method) == "paths" ? Given{{"points", "2"}} : kFewPhotons;
    EXPECT_EQ(lightVpls(world, kept, with(options, few)).table.indirectShare, kept.indirectShare)
        << method;
  }
  EXPECT_EQ(placeVpls(world, {{"method", "light"}, {"count", "2k"}}).table.indirectShare, 1.0);
}

TEST(IndirectShare, ForgedSharesOfShardsAreRefused) {
  std::string record;
  const ShardSink sink{[&](std::string_view, uint64_t, std::string_view bytes) { record = bytes; },
                       {}};
  const ShardSource source{
      [&](std::string_view, uint64_t) { return std::optional<std::string>(record); }, {}};
  for (const double good : {0.0, 0.25, 1.0}) {
    giveIndirectShare(sink, good);
    EXPECT_EQ(takeIndirectShare(source), good);
  }
  for (const double bad : {-0.25, 1.5, std::numeric_limits<double>::quiet_NaN()}) {
    giveIndirectShare(sink, bad);
    EXPECT_THROW(takeIndirectShare(source), InputError);
  }
  record.clear();
  EXPECT_THROW(takeIndirectShare(source), InputError);
}

}  // namespace
}  // namespace bnvpl::test
