// Neighbour queries against a search of all points.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/random.h"
#include "core/random_streams.h"
#include "spatial/all_neighbours.h"
#include "spatial/cell_lists.h"
#include "spatial/kd_tree.h"
#include "spatial/morton_order.h"
#include "spatial/reach_grid.h"
#include "spatial/region_grid.h"
#include "spatial/represented_area.h"
#include "tests/eliminate/clouds.h"

namespace bnvpl {
namespace {

std::vector<Neighbour> allByDistance(const std::vector<Vec3>& points, Vec3 centre) {
  std::vector<Neighbour> all;
  for (size_t i = 0; i < points.size(); ++i) {
    all.push_back({lengthSquared(points[i] - centre), static_cast<uint32_t>(i)});
  }
  std::sort(all.begin(), all.end());
  return all;
}

// The lattice has many points at exactly the radius and many equal distances; an offset makes
// coordinates negative or large.
std::vector<std::vector<Vec3>> clouds() {
  std::vector<std::vector<Vec3>> all{cube(2000, 1.0f, 1).position,
                                     unevenPlane(2000, 2).position,
                                     {{1, 2, 3}},
                                     std::vector<Vec3>(100, Vec3(4.0f))};
  std::vector<Vec3> lattice, far;
  for (int i = 0; i < 1000; ++i) {
    const int x = i % 10, y = i / 10 % 10, z = i / 100;
    lattice.emplace_back(static_cast<float>(x) - 5.0f, static_cast<float>(y) - 5.0f,
                         static_cast<float>(z) - 5.0f);
    far.push_back(lattice.back() * 0.01f + Vec3(-3000.0f, 2000.0f, 1000.0f));
  }
  all.push_back(lattice);
  all.push_back(far);
  return all;
}

TEST(Spatial, NearestAreOrderedAndTiesGoToTheLowerIndex) {
  for (const std::vector<Vec3>& points : clouds()) {
    const KdTree tree(points);
    const AllNeighbours all(points);
    std::vector<Neighbour> found;
    AllNeighbours::Query query, next;
    for (size_t q = 0; q < points.size(); q += 97) {
      for (const size_t count : {1u, 7u, 60u, 5000u}) {
        std::vector<Neighbour> expected = allByDistance(points, points[q]);
        expected.resize(std::min(count, expected.size()));
        tree.nearest(points[q], count, found);
        EXPECT_EQ(found, expected);
        all.nearest(static_cast<uint32_t>(q), count, query, found);
        EXPECT_EQ(found, expected);
        if (count != 60) continue;
        all.nearest(static_cast<uint32_t>(q), count, next, found);  // bound by the last point's
        EXPECT_EQ(found, expected);
      }
    }
  }
}

TEST(Spatial, NoPoints) {
  const std::vector<Vec3> none;
  std::vector<Neighbour> found{{1.0f, 2}};
  KdTree(none).nearest({}, 3, found);
  EXPECT_TRUE(found.empty());
  AllNeighbours{none};
  EXPECT_TRUE(makeCellLists(none, {}).order.empty());
}

// Every pair nearer than the sum of its radii must be listed exactly once, from either end, before
// and after points are removed.
void expectAllPairs(const std::vector<Vec3>& points, const std::vector<float>& radius) {
  CellLists lists = makeCellLists(points, radius);
  std::vector<uint32_t> order = lists.order;
  ASSERT_EQ(order.size(), points.size());
  for (const bool compacted : {false, true}) {
    if (compacted) {
      std::vector<uint8_t> kept(order.size());
      std::vector<uint32_t> rest;
      for (size_t k = 0; k < order.size(); ++k) {
        kept[k] = (k * 7 + 3) % 5 < 2;
        if (kept[k]) rest.push_back(order[k]);
      }
      lists.compact(kept);
      EXPECT_EQ(lists.order, rest);
      order = rest;
    }
    for (uint32_t k = 0; k < order.size(); ++k) {
      std::vector<bool> listed(order.size(), false);
      for (const CellLists::Range range : lists.near(k)) {
        ASSERT_LE(range.end, order.size());
        for (uint32_t n = range.begin; n < range.end; ++n) {
          ASSERT_FALSE(listed[n]) << "twice";
          listed[n] = true;
        }
      }
      for (uint32_t n = 0; n < order.size(); ++n) {
        const float reach = radius[order[k]] + radius[order[n]];
        if (lengthSquared(points[order[n]] - points[order[k]]) < reach * reach) {
          ASSERT_TRUE(listed[n]) << k << ' ' << n;
        }
      }
    }
  }
}

TEST(Spatial, CellListsMissNoPair) {
  for (const std::vector<Vec3>& points : clouds()) {
    for (const float size : {0.01f, 0.1f, 1.0f}) {
      std::vector<float> equal(points.size(), size), uneven(points.size());
      Rng rng(streamKey(5, RandomStream::Plot), 0);
      for (float& r : uneven) r = size * std::pow(2.0f, -12.0f * rng.next());
      expectAllPairs(points, equal);
      expectAllPairs(points, uneven);
    }
  }
}

TEST(Spatial, CellListsLeaveTheFarAway) {
  const std::vector<Vec3> points = unevenPlane(2000, 2).position;
  const CellLists lists = makeCellLists(points, std::vector<float>(points.size(), 0.02f));
  size_t listed = 0, pairs = 0;
  for (uint32_t k = 0; k < points.size(); ++k) {
    for (const CellLists::Range range : lists.near(k)) listed += range.end - range.begin;
    for (const Vec3 p : points) pairs += lengthSquared(p - points[lists.order[k]]) < 0.04f * 0.04f;
  }
  EXPECT_LT(listed, 6 * pairs);
}

// The radii range from denormal to larger than the cloud.
TEST(Spatial, DisksThatReachAreAllFound) {
  for (const std::vector<Vec3>& points : clouds()) {
    std::vector<float> radius(points.size());
    Rng rng(streamKey(6, RandomStream::Plot), 0);
    for (float& r : radius) r = std::pow(2.0f, 3.0f - 12.0f * rng.next());
    if (points.size() > 1) radius[0] = 1e-42f, radius[1] = 1e6f;
    const std::vector<Vec3> normals(points.size(), Vec3{0, 0, 1});
    const ReachGrid grid(points, normals, radius);
    for (size_t q = 0; q < points.size(); q += 37) {
      const Vec3 at = points[q] + Vec3(0.0f, 0.0f, q % 2 ? 0.5f * radius[q] : 0.0f);
      std::vector<uint32_t> found, expected;
      ReachGrid::forEachReaching(grid.lookUp(at),
                                 [&](const ReachGrid::Disk& d) { found.push_back(d.index); });
      std::sort(found.begin(), found.end());
      for (uint32_t i = 0; i < points.size(); ++i) {
        if (lengthSquared(points[i] - at) < radius[i] * radius[i]) expected.push_back(i);
      }
      EXPECT_EQ(found, expected);
    }
  }
}

TEST(Spatial, SharesAreTheSameWithTheShortQuery) {
  const Cloud cloud = cube(3000, 1.0f, 3);
  const std::vector<float> all = representedAreas(cloud.position, cloud.normal, 20);
  const std::vector<uint32_t> rows{0, 17, 2999};
  const KdTree tree(cloud.position);
  const std::vector<float> some = representedAreas(cloud.position, cloud.normal, 20, tree, rows);
  for (size_t i = 0; i < rows.size(); ++i) EXPECT_EQ(some[i], all[rows[i]]);
}

// A point alone on its compatible surface gets the density of everything near it; coincident points
// get a positive share.
TEST(Spatial, SharesOfOddPoints) {
  Cloud cloud = plane(1000, 1.0f, 1.0f, 4);
  cloud.add({0.5f, 0.5f, 0.0f}, {1, 0, 0});
  for (int i = 0; i < 100; ++i) cloud.add({0.2f, 0.2f, 0.0f}, {0, 0, 1});
  const std::vector<float> share = representedAreas(cloud.position, cloud.normal, 20);
  EXPECT_GT(share[1000], 0.0003f);
  EXPECT_LT(share[1000], 0.003f);
  EXPECT_GT(share[1050], 0.0f);
  EXPECT_LT(share[1050], 1e-9f);
  EXPECT_EQ(
      representedAreas(std::vector<Vec3>(5, Vec3(1.0f)), std::vector<Vec3>(5, Vec3(0, 0, 1)), 3),
      std::vector<float>(5, 3.0f));  // all coincide: the squared distance from the origin
}

TEST(Spatial, MortonOrderIsAPermutation) {
  const Cloud cloud = cube(5000, 7.0f, 5);
  std::vector<uint32_t> order = mortonOrder(cloud.position);
  double step = 0.0;
  for (size_t i = 1; i < order.size(); ++i) {
    step += length(cloud.position[order[i]] - cloud.position[order[i - 1]]);
  }
  EXPECT_LT(step / 5000.0, 0.5);  // a random order would give about 4
  std::sort(order.begin(), order.end());
  for (uint32_t i = 0; i < order.size(); ++i) ASSERT_EQ(order[i], i);
  EXPECT_TRUE(mortonOrder({}).empty());
}

TEST(RegionGrid, NamesTheDiskOnThePointsOwnSurface) {
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {0, 0, 0.001f}, {40, 0, 0}};
  const std::vector<Vec3> normals{{0, 0, -1}, {0, 0, -1}, {0, 0, 1}, {1, 0, 0}};
  const std::vector<float> radii{0.5f, 0.5f, 0.5f, 6.0f};
  const RegionGrid grid(points, normals, radii);
  EXPECT_EQ(grid.at({0.1f, 0.1f, 0.0f}, {0, 0, -1}), 0u);
  EXPECT_EQ(grid.at({1.1f, 0.1f, 0.0f}, {0, 0, -1}), 1u);
  EXPECT_EQ(grid.at({0.1f, 0.1f, 0.0f}, {0, 0, 1}), 2u);  // the other side of the wall
  EXPECT_EQ(grid.at({0.1f, 0.1f, 0.0f}, {0, 1, 0}), UINT32_MAX);
  EXPECT_EQ(grid.at({40, 3, -3}, {1, 0, 0}), 3u);
  EXPECT_EQ(grid.at({0, 0, 9}, {0, 0, -1}), UINT32_MAX);
  EXPECT_EQ(RegionGrid().at({}, {0, 0, 1}), UINT32_MAX);
}

TEST(RegionGrid, CellsAreNotTakenForOthersFarAway) {
  const std::vector<Vec3> point{{0, 0, 0}}, normal{{0, 0, 1}};
  const std::vector<float> radius{0.001f};
  const RegionGrid grid(point, normal, radius);
  EXPECT_EQ(grid.at({0.0002f, 0.0002f, 0}, {0, 0, 1}), 0u);
  for (int power = 0; power < 20; ++power)
    EXPECT_EQ(grid.at({std::ldexp(1.0f, power), 0, 0}, {0, 0, 1}), UINT32_MAX) << power;
}

}  // namespace
}  // namespace bnvpl
