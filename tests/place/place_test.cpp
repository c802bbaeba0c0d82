#include "tools/place/place.h"

#include <gtest/gtest.h>

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
