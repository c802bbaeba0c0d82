#include "tools/place/place.h"

#include <gtest/gtest.h>

#include "tests/support/pipeline.h"

namespace bnvpl::test {
namespace {

PlaceOptions options(uint64_t count) {
  PlaceOptions o;
  o.count = count;
  return o;
}

TEST(Place, GivesExactlyTheCountInPathOrder) {
  const World world("u-shape/scene.toml");
  // Two waves of paths and three: one is joined while the next is traced.
  const VplTable few = placeFromCamera(world.rays, options(70000)).table;
  const VplTable more = placeFromCamera(world.rays, options(140000)).table;
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
  const VplTable t = placeFromCamera(world.rays, options(2000)).table;
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
    placeFromCamera(world.rays, options(100));
    FAIL() << "the view cannot yield candidates";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("only 0 of 100 VPLs"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("left the scene"), std::string::npos) << e.what();
  }
}

TEST(Place, LightMethodCarriesThePowerOfTheFirstHits) {
  const World world("cornell/scene.toml");
  PlaceOptions o = options(40000);
  o.lightDepth = 1;
  const VplTable t = placeFromLights(world.rays, world.lights, o).table;
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
  PlaceOptions deep = options(3000);
  deep.depth = 4;
  const PlaceResult two = placeFromCamera(world.rays, options(3000));
  const PlaceResult four = placeFromCamera(world.rays, deep);
  EXPECT_LT(four.paths * 2, two.paths);  // up to three a path instead of one
}

// Paths are traced many at a time. In a closed room nearly every second vertex has a third, which
// comes before the next path's second.
TEST(Place, VerticesOfOnePathStayTogether) {
  const World world("u-shape/scene.toml");
  PlaceOptions deep = options(4000);
  deep.depth = 3;
  const VplTable two = placeFromCamera(world.rays, options(2000)).table;
  const VplTable three = placeFromCamera(world.rays, deep).table;
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
