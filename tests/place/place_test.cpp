#include "tools/place/place.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <optional>

#include "tests/support/pipeline.h"
#include "tests/support/threads.h"

namespace bnvpl::test {
namespace {

Given count(uint64_t vpls) { return {{"count", typed(vpls)}}; }

TEST(Place, ThreadsGiveExactlyTheCountInPathOrder) {
  const World world("u-shape/scene.toml");
  // The runs take two and three waves of paths: one wave is joined while the next is traced.
  const auto placed = [&](uint64_t vpls) {
    return withThreads(7, [&] { return placeVpls(world, count(vpls)).table; });
  };
  const VplTable few = placed(70000), more = placed(140000);
  ASSERT_EQ(few.size(), 70000u);
  ASSERT_EQ(more.size(), 140000u);
  for (size_t i = 0; i < few.size(); ++i) {
    ASSERT_EQ(few.position[i], more.position[i]);
    ASSERT_EQ(few.id[i], i);
  }
}

// A run that begins anew after each pause would never end.
TEST(Place, ContinuesFromEveryPause) {
  struct Stopped {};
  const World world("u-shape/scene.toml");
  const Given given = count(140000);
  const PlaceViews views(world.scene);
  std::string state;
  size_t pauses = 0;
  std::optional<VplTable> table;
  while (!table) {
    WorkControls controls;
    controls.state = state;
    controls.pause = [] { return true; };
    controls.save = [&](const std::string& saved) {
      state = saved;
      throw Stopped();
    };
    try {
      const Values options = resolve(placeSpec(), given);
      table = place({world.accel, world.lights, views}, options, {}, controls).table;
    } catch (const Stopped&) {
      ASSERT_LT(++pauses, 20u);
    }
  }
  EXPECT_GT(pauses, 1u);
  const VplTable whole = placeVpls(world, given).table;
  EXPECT_EQ(table->position, whole.position);
  EXPECT_EQ(table->id, whole.id);
  EXPECT_EQ(table->indirectShare, whole.indirectShare);
}

// Rows of shards; the merge asks for missing ones by their unit.
TEST(Place, ShardsEndWithEnoughOfTheirPathsForAllTogether) {
  const World world("u-shape/scene.toml");
  const Values options = resolve(placeSpec(), count(60000));
  const PlaceViews views(world.scene);
  std::map<std::pair<std::string, uint64_t>, std::string> records;
  ShardSink sink;
  sink.record = [&](std::string_view work, uint64_t unit, std::string_view bytes) {
    EXPECT_TRUE(records.emplace(std::pair(work, unit), bytes).second) << "twice: " << unit;
  };
  for (uint64_t i = 0; i < 5; ++i) {
    WorkControls controls;
    controls.shard = {i, i + 1, 5};
    controls.sink = &sink;
    placeShard({world.accel, world.lights, views}, options, 0.0, controls);
  }
  ShardSource source;
  source.record = [&](std::string_view work, uint64_t unit) -> std::optional<std::string> {
    const auto found = records.find({std::string(work), unit});
    if (found == records.end()) return {};
    return found->second;
  };
  const uint64_t hash = world.scene.contentHash;
  const auto never = [](uint64_t) { FAIL(); };
  const VplTable joined = joinPlaced(options, hash, views.turns, source, never).table,
                 whole = placeVpls(world, count(60000)).table;
  EXPECT_EQ(joined.position, whole.position);
  EXPECT_EQ(joined.indirectShare, whole.indirectShare);
  struct Early {
    uint64_t unit;
  };
  records.erase({"paths", 7});
  try {
    joinPlaced(options, hash, views.turns, source, [](uint64_t unit) { throw Early{unit}; });
    FAIL();
  } catch (const Early& early) {
    EXPECT_EQ(early.unit, 7u);
  }
}

// After any number of paths, each view has its share to within one path. Its paths have consecutive
// numbers of its own.
TEST(Place, ViewsTakeTurnsByTheirShares) {
  const std::vector<uint64_t> shares{5, 1, 3};
  const ViewTurns turns(shares);
  std::vector<uint64_t> paths(shares.size());
  for (uint64_t path = 0; path < 1000; ++path) {
    const ViewTurns::Turn turn = turns.of(path);
    ASSERT_EQ(turn.path, paths[turn.view]++);
    for (size_t v = 0; v < shares.size(); ++v) {
      ASSERT_NEAR(double(paths[v]), double(shares[v] * (path + 1)) / 9.0, 1.0) << path;
    }
  }
}

// One camera in each room of the U-shape. VPLs for both, by shares, have the mean of the two
// densities, which differ between the rooms.
class TwoRooms : public ::testing::Test {
 protected:
  const World world{"u-shape/scene.toml"};
  View left() const { return {"", world.scene.camera, {24, 18}}; }
  View right() const {
    View view = left();
    view.camera.position.x = -view.camera.position.x;
    return view;
  }
  VplTable placed(const std::vector<View>& views, const std::vector<uint64_t>& shares,
                  const Given& options) const {
    return place({world.accel, world.lights, PlaceViews(views, shares)},
                 resolve(placeSpec(), options))
        .table;
  }
  static double inTheRight(const VplTable& table) {
    return double(std::ranges::count_if(table.position, [](Vec3 p) { return p.x > 0; })) /
           double(table.size());
  }
};

TEST_F(TwoRooms, CandidatesHaveTheDensityOfTheViewsByTheirShares) {
  const double ofLeft = inTheRight(placed({left()}, {1}, count(20000))),
               ofRight = inTheRight(placed({right()}, {1}, count(20000)));
  ASSERT_GT(ofRight, ofLeft + 0.5);
  const PlaceViews views({left(), right()}, {3, 1});
  const PlaceResult both =
      place({world.accel, world.lights, views}, resolve(placeSpec(), count(20000)));
  ASSERT_EQ(both.rowsOfView.size(), 2u);
  EXPECT_EQ(both.rowsOfView[0] + both.rowsOfView[1], 20000u);
  const double share = double(both.rowsOfView[1]) / 20000.0;
  EXPECT_NEAR(share, 0.25, 0.02);
  EXPECT_NEAR(inTheRight(both.table), (1.0 - share) * ofLeft + share * ofRight, 0.02);
}

// VPLs placed for both views light each as well as its own VPLs do, even without compensation. A
// region that represented one view only would leave the other dark.
TEST_F(TwoRooms, OneSetOfVplsLightsEachView) {
  World seen{"u-shape/scene.toml"};
  const VplTable vpls = keepVpls(placed({left(), right()}, {1, 1}, kFewCandidates),
                                 with(kFewVpls, {{"count", "2000"}}));
  const VplTable lit = lightVpls(seen, vpls, {{"photons", "1M"}}).table;
  for (const View& view : {left(), right()}) {
    seen.scene.camera = view.camera;
    seen.scene.film = view.film;
    const Given indirect{{"only", "indirect"}, {"spp", "4"}};
    const double compensated = renderVpls(seen, lit, indirect).stats.indirect,
                 alone = indirectByVpls(seen, lit, {{"gather", "tilecuts"}, {"clamp", "0.1"}});
    VplTable own = lightVpls(seen, keptVpls(seen, {{"count", "2000"}}), {{"photons", "1M"}}).table;
    const double byOwn = indirectByVpls(seen, own, {{"gather", "tilecuts"}, {"clamp", "0.1"}});
    EXPECT_NEAR(alone / byOwn, 1.0, 0.08);
    EXPECT_NEAR(compensated / renderVpls(seen, own, indirect).stats.indirect, 1.0, 0.05);
  }
}

// Each candidate lies on a surface and faces free space: a ray onto its lit side hits it.
TEST(Place, CandidatesLieOnSurfacesAndFaceTheSideTheyWereSeenFrom) {
  const World world("u-shape/scene.toml");
  const VplTable t = placeVpls(world, count(2000)).table;
  for (size_t i = 0; i < t.size(); ++i) {
    ASSERT_NEAR(length(t.normal[i]), 1.0f, 1e-5f);
    SurfacePoint hit;
    ASSERT_TRUE(world.accel.closestHit(t.position[i] + t.normal[i] * 1e-3f, -t.normal[i], hit));
    EXPECT_NEAR(hit.distance, 1e-3f, 2e-4f);
    EXPECT_GT(dot(hit.ng, t.normal[i]), 0.999f);
  }
}

}  // namespace
}  // namespace bnvpl::test
