#include "tools/place/place.h"

#include <gtest/gtest.h>

#include "tests/support/pipeline.h"

namespace bnvpl::test {
namespace {

Given count(uint64_t vpls) { return {{"count", std::to_string(vpls)}}; }

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

// The plane fills the lower half of the view; paths from it reach the sky alone. Were anything
// placed at the first diffuse vertex, the count would be reached at once.
TEST(Place, NothingIsPlacedAtTheFirstDiffuseVertex) {
  const World world(
      "test/two-patches.toml");  // receiver seen alone; the emitter above reflects nothing
  try {
    placeVpls(world, count(100));
    FAIL() << "the view cannot yield candidates";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("only 0 of 100 VPLs"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("left the scene"), std::string::npos) << e.what();
  }
}

TEST(Place, LightMethodCarriesThePowerOfTheFirstHits) {
  const World world("cornell/scene.toml");
  const VplTable t =
      placeVpls(world, with(count(40000), {{"method", "light"}, {"light-depth", "1"}})).table;
  ASSERT_EQ(t.stage, VplStage::Lit);
  // With one bounce, flux out = albedo * power, less what escapes through the open front.
  double flux = 0.0, bound = 0.0;
  float maxAlbedo = 0.0f;
  for (size_t i = 0; i < t.size(); ++i) {
    flux += double{mean(t.flux[i])};
    maxAlbedo = std::max(maxAlbedo, maxComponent(t.albedo[i]));
  }
  bound = double{mean(world.lights.totalPower())} * double{maxAlbedo};
  EXPECT_LT(flux, bound);
  EXPECT_GT(flux, 0.5 * bound);
}

TEST(Place, DeeperPathsAddCandidatesAtLaterVertices) {
  const World world("u-shape/scene.toml");
  const PlaceResult two = placeVpls(world, count(3000));
  const PlaceResult four = placeVpls(world, with(count(3000), {{"depth", "4"}}));
  EXPECT_LT(four.paths * 2, two.paths);  // up to three a path instead of one
}

// Paths are traced many at a time. In a closed room nearly every second vertex has a third, which
// comes before the next path's second.
TEST(Place, VerticesOfOnePathStayTogether) {
  const World world("u-shape/scene.toml");
  const VplTable two = placeVpls(world, count(2000)).table;
  const VplTable three = placeVpls(world, with(count(4000), {{"depth", "3"}})).table;
  size_t found = 0, apart = 0, before = 0;
  for (size_t i = 0; i < three.size() && found < two.size(); ++i) {
    if (three.position[i] != two.position[found]) continue;
    apart += found > 0 && i - before == 2;
    before = i;
    ++found;
  }
  EXPECT_GT(found, 1900u);
  EXPECT_GT(apart, found * 9 / 10);
}

}  // namespace
}  // namespace bnvpl::test
