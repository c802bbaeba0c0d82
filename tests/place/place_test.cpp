#include "tools/place/place.h"

#include <gtest/gtest.h>

#include "tests/support/pipeline.h"

namespace bnvpl::test {
namespace {

Given count(uint64_t vpls) { return {{"count", std::to_string(vpls)}}; }
Given fromLights(uint64_t vpls) { return with(count(vpls), {{"method", "light"}}); }

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

// A closed cube of edge 1 about (1/2, 1/2, 1/2) that reflects half.
World greyCube(const std::vector<Vec3>& intensities) {
  Scene scene = loadScene(fs::path(BNVPL_SCENES_DIR) / "furnace/scene.toml");
  for (Material& m : scene.materials) m.emission = {};
  for (const Vec3 intensity : intensities) {
    LightSpec l;
    l.position = {0.4f, 0.5f, 0.6f};
    l.emission = intensity;
    scene.lights.push_back(l);
  }
  return World(std::move(scene));
}

TEST(Place, CandidatesFaceIntoAClosedRoomAndHaveItsAlbedo) {
  const World world = greyCube({});
  const VplTable t = placeVpls(world, count(3000)).table;
  for (size_t i = 0; i < t.size(); ++i) {
    // 1/2 along the wall's axis, from the wall to the middle.
    ASSERT_NEAR(dot(t.normal[i], Vec3(0.5f) - t.position[i]), 0.5f, 1e-5f);
    ASSERT_EQ(t.albedo[i], Vec3(0.5f));
  }
}

double totalOf(const std::vector<Vec3>& column, size_t channel) {
  double sum = 0.0;
  for (const Vec3 v : column) sum += double{v[channel]};
  return sum;
}

// In a closed room every photon hits, and its first hit reflects half of its flux, exactly.
TEST(Place, LightMethodCarriesThePowerOfTheFirstHits) {
  const World world = greyCube({{3, 2, 1}});
  const PlaceResult placed = placeVpls(world, with(fromLights(5000), {{"light-depth", "1"}}));
  ASSERT_EQ(placed.table.stage, VplStage::Lit);
  EXPECT_EQ(placed.paths, 5000u);
  for (size_t c = 0; c < 3; ++c) {
    const double expected = 0.5 * double{world.lights.totalPower()[c]};
    EXPECT_NEAR(totalOf(placed.table.flux, c), expected, 1e-4 * expected);
    EXPECT_NEAR(totalOf(placed.table.firstBounceFlux, c), expected, 1e-4 * expected);
  }
}

// All hits together reflect rho / (1 - rho) = 1 of the power, to within sqrt(1/2 / paths), and the
// first ones rho = 1/2; of lamps whose powers are far apart, each its own.
TEST(Place, LightMethodCarriesThePowerOfEachLight) {
  const World world = greyCube({{1, 0, 0}, {0, 0, 0.04f}});
  const PlaceResult placed = placeVpls(world, fromLights(200000));
  const auto paths = double(placed.paths);
  for (const size_t c : {0u, 2u}) {
    const double power = double{world.lights.power(c / 2)[c]},
                 share = double{world.lights.pickProbability(c / 2)};
    // The number of photons of a lamp is random too.
    const double error = 5.0 * std::sqrt(1.5 / (share * paths));
    EXPECT_NEAR(totalOf(placed.table.flux, c) / power, 1.0, error);
    EXPECT_NEAR(totalOf(placed.table.firstBounceFlux, c) / power, 0.5, 0.5 * error);
  }
  EXPECT_EQ(totalOf(placed.table.flux, 1), 0.0);
  // Every VPL stands for a share of the surface: six squares. Hexagons of radius r have this area.
  double area = 0.0;
  for (const float r : placed.table.radius) area += 2.0 * std::sqrt(3.0) * double{r} * double{r};
  EXPECT_NEAR(area, 6.0, 0.3);
  EXPECT_NEAR(placed.table.areaEstimate, area, 1e-3);
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
