#include <gtest/gtest.h>

#include "tests/support/grey_cube.h"

namespace bnvpl::test {
namespace {

Given count(uint64_t vpls) { return {{"count", typed(vpls)}}; }

// The plane fills the lower half of the view, and paths from it only reach the sky. If candidates
// were placed at the first diffuse vertex, the count would be reached at once.
TEST(PlaceCamera, NothingIsPlacedAtTheFirstDiffuseVertex) {
  const World world(
      "test/two-patches.toml");  // only the receiver is visible; the emitter reflects nothing
  try {
    placeVpls(world, count(100));
    FAIL() << "the view cannot yield candidates";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("only 0 of 100 VPLs"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("left the scene"), std::string::npos) << e.what();
  }
}

TEST(PlaceCamera, CandidatesFaceIntoAClosedRoomAndHaveItsAlbedo) {
  const World world = greyCube({});
  const VplTable t = placeVpls(world, count(3000)).table;
  for (size_t i = 0; i < t.size(); ++i) {
    // Each wall is 1/2 away from the centre of the unit cube.
    ASSERT_NEAR(dot(t.normal[i], Vec3(0.5f) - t.position[i]), 0.5f, 1e-5f);
    ASSERT_EQ(t.albedo[i], Vec3(0.5f));
  }
}

TEST(PlaceCamera, DeeperPathsAddCandidatesAtLaterVertices) {
  const World world("u-shape/scene.toml");
  const PlaceResult two = placeVpls(world, count(3000));
  const PlaceResult four = placeVpls(world, with(count(3000), {{"depth", "4"}}));
  EXPECT_LT(four.paths * 2, two.paths);  // a path yields up to three candidates instead of one
}

// Paths are traced in batches. In a closed room nearly every path with a second vertex has a third
// one, which comes before the second vertex of the next path.
TEST(PlaceCamera, VerticesOfOnePathStayTogether) {
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
