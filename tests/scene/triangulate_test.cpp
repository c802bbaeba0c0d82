// The triangles cover polygons of any shape exactly.
#include "scene/triangulate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <ctime>
#include <numbers>
#include <random>

#include "tests/scene/scene_files.h"
#include "tests/support/sanitizers.h"

namespace bnvpl {
namespace {

using Flat = std::vector<std::array<double, 2>>;
using Triangles = std::vector<std::array<uint32_t, 3>>;

double area(const Flat& p) {
  double sum = 0.0;
  for (size_t i = 0, j = p.size() - 1; i < p.size(); j = i++)
    sum += p[j][0] * p[i][1] - p[i][0] * p[j][1];
  return 0.5 * sum;
}

bool isInside(const Flat& polygon, double x, double y) {  // even-odd
  bool inside = false;
  for (size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const auto &a = polygon[i], &b = polygon[j];
    if ((a[1] > y) != (b[1] > y) && x < (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1]) + a[0])
      inside = !inside;
  }
  return inside;
}

// A star around the middle with a random radius at each angle, which is always a simple polygon.
Flat star(std::mt19937& random, size_t corners) {
  std::uniform_real_distribution<double> radius(0.05, 1.0);
  Flat out;
  for (size_t i = 0; i < corners; ++i) {
    const double angle = 2.0 * std::numbers::pi * double(i) / double(corners), r = radius(random);
    out.push_back({r * std::cos(angle), r * std::sin(angle)});
  }
  return out;
}

// A comb; from most of its teeth, few others are visible.
Flat comb(std::mt19937& random, size_t corners) {
  std::uniform_real_distribution<double> height(-0.9, 1.0);
  Flat out;
  const size_t top = corners - 2;
  for (size_t i = 0; i < top; ++i)
    out.push_back({1.0 - 2.0 * double(i) / double(top - 1), height(random)});
  out.push_back({-1.0, -1.0});
  out.push_back({1.0, -1.0});
  return out;
}

// A star inside a star, joined by a bridge from the outline's corner `at`.
Flat ring(std::mt19937& random, size_t corners) {
  const double turn = 2.0 * std::numbers::pi / double(corners);
  std::uniform_real_distribution<double> outer(0.7, 1.0), inner(0.1, 0.5);
  const size_t at = random() % corners;
  Flat out;
  for (size_t i = 0; i <= corners; ++i) {  // the outline returns to its start
    const double angle = turn * double(at + i);
    const double r = i == corners ? std::hypot(out[0][0], out[0][1]) : outer(random);
    out.push_back(i == corners ? out[0] : std::array{r * std::cos(angle), r * std::sin(angle)});
  }
  const size_t hole = out.size();
  for (size_t i = 0; i <= corners; ++i) {
    const double angle = turn * (double(at) - double(i)), r = inner(random);
    out.push_back(i == corners ? out[hole] : std::array{r * std::cos(angle), r * std::sin(angle)});
  }
  return out;
}

// Maps the flat polygon into a random plane.
std::vector<FilePoint> inPlane(std::mt19937& random, const Flat& flat) {
  std::normal_distribution<double> normal;
  const Affine toWorld =
      Affine::fromParts({normal(random), normal(random), normal(random)},
                        {3 * normal(random), 3 * normal(random), normal(random)}, {1, 1, 1});
  std::vector<FilePoint> out;
  for (const auto& [x, y] : flat) out.push_back(toWorld.point({x, y, 0}));
  return out;
}

void expectCovered(std::mt19937& random, Flat flat, const char* what) {
  std::rotate(flat.begin(), flat.begin() + long(random() % flat.size()), flat.end());
  Triangles triangles;
  EXPECT_TRUE(triangulate(inPlane(random, flat), QuadCut::ShorterDiagonal, triangles)) << what;
  double sum = 0.0;
  for (const auto& [a, b, c] : triangles) {
    const double part = area({flat[a], flat[b], flat[c]});
    EXPECT_GT(part, 0.0) << what;
    sum += part;
    const double x = (flat[a][0] + flat[b][0] + flat[c][0]) / 3.0;
    const double y = (flat[a][1] + flat[b][1] + flat[c][1]) / 3.0;
    EXPECT_TRUE(part < 1e-9 || isInside(flat, x, y)) << what;
  }
  EXPECT_NEAR(sum, area(flat), 1e-5 * area(flat)) << what << flat.size();
}

TEST(Triangulate, SimplePolygonsKeepTheirArea) {
  std::mt19937 random(1);
  for (size_t corners = 4; corners <= 40; ++corners) {
    for (int i = 0; i < 20; ++i) {
      expectCovered(random, star(random, corners), "star");
      expectCovered(random, comb(random, corners), "comb");
    }
  }
}

TEST(Triangulate, HolesStayOpenBehindBridges) {
  std::mt19937 random(2);
  for (size_t corners = 5; corners <= 20; ++corners) {
    for (int i = 0; i < 20; ++i) expectCovered(random, ring(random, corners), "ring");
  }
}

TEST(Triangulate, TwoHolesOfOneCornerAndIslandsOnABridge) {
  std::mt19937 random(3);
  const Flat holes{{0, 0}, {.5, 1}, {.5, 2}, {1, 2}, {.5, 1}, {0, 0}, {1, .5}, {1, 1},
                   {2, 1}, {2, .5}, {1, .5}, {0, 0}, {4, 0},  {4, 4}, {0, 4}};
  const Flat islands{{0, 0}, {1, 0}, {1, 1}, {2, 1}, {2, 0},
                     {3, 0}, {3, 1}, {2, 1}, {1, 1}, {0, 1}};
  for (int i = 0; i < 200; ++i) {
    expectCovered(random, holes, "holes");
    expectCovered(random, islands, "islands");
  }
}

TEST(Triangulate, CornersInLineAndDoubledOnesCostNothing) {
  std::mt19937 random(4);
  const Flat square{{0, 0}, {.1, 0}, {.2, 0}, {.3, 0}, {.3, 0},
                    {1, 0}, {1, 1},  {1, 1},  {.7, 1}, {0, 1}};
  for (int i = 0; i < 100; ++i) expectCovered(random, square, "square");
}

TEST(Triangulate, CrossingOutlinesAreReported) {
  const auto cut = [](const std::vector<FilePoint>& corners) {
    Triangles triangles;
    const bool whole = triangulate(corners, QuadCut::ShorterDiagonal, triangles);
    EXPECT_FALSE(triangles.empty());
    return whole;
  };
  EXPECT_FALSE(cut({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}));
  std::vector<FilePoint> pentagram;
  for (int i = 0; i < 5; ++i)
    pentagram.push_back({std::cos(i * 2.513274), 0, std::sin(i * 2.513274)});
  EXPECT_FALSE(cut(pentagram));
  EXPECT_TRUE(cut({{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {0, 0, 0}, {2, 0, 0}}));  // flat polygon
}

TEST(Triangulate, AnySizeAndPlaceOfNumbers) {
  for (const double scale : {1e-300, 1e-20, 1.0, 1e20, 1e300}) {
    std::vector<FilePoint> l{{-1, 1, 0}, {0, 1, 0}, {0, 0, 0}, {1, 0, 0}, {1, -1, 0}, {-1, -1, 0}};
    for (FilePoint& p : l) p = {p[1] * scale, p[0] * scale, 3 * scale};
    Triangles triangles;
    EXPECT_TRUE(triangulate(l, QuadCut::FirstCorner, triangles)) << scale;
    EXPECT_EQ(triangles.size(), 4u) << scale;
  }
  Triangles triangles;
  EXPECT_TRUE(triangulate(std::vector<FilePoint>(5, {NAN, 0, 0}), QuadCut::FirstCorner, triangles));
}

// Blender writes a wall with a window as two C shapes of eight corners.
using Polygons = SceneFiles;
TEST_F(Polygons, OfAnObjAreCutByTheirShape) {
  const Scene s = loadMesh(
      "mtllib square.mtl\nv -3 -1 0\nv 3 -1 0\nv 3 3 0\nv -3 3 0\nv -1 0 0\nv 1 0 0\nv 1 2 0\nv -1 "
      "2 0\n"
      "usemtl paint\nf 1 2 6 5 8 4\nf 2 3 4 8 7 6\n",
      "newmtl paint\nKd 1 1 1\n");
  EXPECT_NEAR(areaOfMaterial(s, "paint"), 24.0 - 4.0, 1e-5);
  EXPECT_EQ(joined(s.warnings), joined({s.warnings.front()}));
}

// Cutting tests each edge against each ear. Bounding boxes leave few of these tests.
TEST(Triangulate, ConcavePolygonsOfManyCornersAreCutSoon) {
  if (kSanitized) GTEST_SKIP() << "sanitizers are slow";
  std::vector<FilePoint> star;
  for (size_t i = 0; i < kMaxPolygonCorners; ++i) {
    const double angle = 2.0 * std::numbers::pi * double(i) / double(kMaxPolygonCorners),
                 radius = i % 2 == 0 ? 1.0 : 0.3;
    star.push_back({radius * std::cos(angle), radius * std::sin(angle), 0.0});
  }
  const std::clock_t begin = std::clock();
  for (int i = 0; i < 20; ++i) {
    std::vector<std::array<uint32_t, 3>> triangles;
    EXPECT_TRUE(triangulate(star, QuadCut::FirstCorner, triangles));
    EXPECT_EQ(triangles.size(), kMaxPolygonCorners - 2);
  }
  const double seconds = double(std::clock() - begin) / CLOCKS_PER_SEC;
  EXPECT_LT(seconds, 1.0);  // a tenth of that, on a processor of 2020
}

}  // namespace
}  // namespace bnvpl
