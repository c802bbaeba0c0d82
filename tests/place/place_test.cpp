#include "tools/place/place.h"

#include <gtest/gtest.h>

#include <map>

#include "tests/support/pipeline.h"

namespace bnvpl::test {
namespace {

Given count(uint64_t vpls) { return {{"count", typed(vpls)}}; }

TEST(Place, GivesExactlyTheCountInPathOrder) {
  const World world("u-shape/scene.toml");
  // Two waves of paths and three: one is joined while the next is traced.
  const VplTable few = placeVpls(world, count(70000)).table;
  const VplTable more = placeVpls(world, count(140000)).table;
  ASSERT_EQ(few.size(), 70000u);
  ASSERT_EQ(more.size(), 140000u);
  for (size_t i = 0; i < few.size(); ++i) {
    ASSERT_EQ(few.position[i], more.position[i]);
    ASSERT_EQ(few.id[i], i);
  }
}

// The rows of shards: what a merge lacks is asked for by its unit.
TEST(Place, ShardsEndWithEnoughOfTheirPathsForAllTogether) {
  const World world("u-shape/scene.toml");
  const Values options = resolve(placeSpec(), count(60000));
  const PlaceViews views(world.scene);
  std::map<uint64_t, std::string> records;
  ShardSink sink;
  sink.record = [&](std::string_view, uint64_t unit, std::string_view bytes) {
    EXPECT_TRUE(records.emplace(unit, bytes).second) << "twice: " << unit;
  };
  for (uint64_t i = 0; i < 5; ++i) {
    Resume resume;
    resume.shard = {i, i + 1, 5};
    resume.sink = &sink;
    placeShard({world.rays, world.lights, views}, options, 0.0, resume);
  }
  ShardSource source;
  source.record = [&](std::string_view, uint64_t unit) -> std::optional<std::string> {
    const auto found = records.find(unit);
    if (found == records.end()) return {};
    return found->second;
  };
  const uint64_t hash = world.scene.contentHash;
  const auto never = [](uint64_t) { FAIL(); };
  EXPECT_EQ(joinPlaced(options, hash, views.turns, source, never).table.position,
            placeVpls(world, count(60000)).table.position);
  struct Early {
    uint64_t unit;
  };
  records.erase(7);
  try {
    joinPlaced(options, hash, views.turns, source, [](uint64_t unit) { throw Early{unit}; });
    FAIL();
  } catch (const Early& early) {
    EXPECT_EQ(early.unit, 7u);
  }
}

// Each candidate lies on a surface and faces free space: a ray down onto its lit side comes back to
// it.
TEST(Place, CandidatesLieOnSurfacesAndFaceTheSideTheyWereSeenFrom) {
  const World world("u-shape/scene.toml");
  const VplTable t = placeVpls(world, count(2000)).table;
  for (size_t i = 0; i < t.size(); ++i) {
    ASSERT_NEAR(length(t.normal[i]), 1.0f, 1e-5f);
    SurfacePoint hit;
    ASSERT_TRUE(world.rays.closestHit(t.position[i] + t.normal[i] * 1e-3f, -t.normal[i], hit));
    EXPECT_NEAR(hit.distance, 1e-3f, 2e-4f);
    EXPECT_GT(dot(hit.ng, t.normal[i]), 0.999f);
  }
}

}  // namespace
}  // namespace bnvpl::test
