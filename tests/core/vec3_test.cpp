#include "core/vec3.h"

#include <gtest/gtest.h>

#include "core/sampling.h"

namespace bnvpl {
namespace {

// Directions that cover the sphere, including the poles and their neighbourhoods.
std::vector<Vec3> manyDirections() {
  std::vector<Vec3> d{{0, 0, 1},         {0, 0, -1},          {1, 0, 0},
                      {0, -1, 0},        {1e-4f, 0, -1.0f},   {0, 1e-6f, -1.0f},
                      {0, -0.0f, -1.0f}, {0, 0, -0.0f + 1.0f}};
  for (int i = 0; i < 32; ++i) {
    for (int j = 0; j < 32; ++j) {
      d.push_back(sampleSphere((float(i) + 0.5f) / 32.0f, (float(j) + 0.25f) / 32.0f));
    }
  }
  for (Vec3& v : d) v = normalize(v);
  return d;
}

TEST(Vec3, Products) {
  const Vec3 a{1, 2, 3}, b{-4, 5, 0.5f};
  EXPECT_EQ(dot(a, b), 7.5f);
  EXPECT_EQ(cross({1, 0, 0}, {0, 1, 0}), Vec3(0, 0, 1));
  EXPECT_EQ(dot(cross(a, b), a), 0.0f);
  EXPECT_EQ(cross(a, b), -cross(b, a));
  EXPECT_EQ(a * b, Vec3(-4, 10, 1.5f));
  EXPECT_EQ(length({2, 3, 6}), 7.0f);
  EXPECT_EQ(reflect({1, 0, 1}, {0, 0, 1}), Vec3(-1, 0, 1));
}

TEST(Vec3, ElementsByAxis) {
  Vec3 a{1, 2, 3};
  EXPECT_EQ(a[0] + 10 * a[1] + 100 * a[2], 321);
  a[1] = 7;
  EXPECT_EQ(a, Vec3(1, 7, 3));
  EXPECT_EQ(maxComponent(a), 7);
}

TEST(Vec3, LuminanceOfWhiteIsOne) {
  EXPECT_FLOAT_EQ(luminance(Vec3(1)), 1.0f);
  EXPECT_GT(luminance({0, 1, 0}), luminance({1, 0, 0}));
  EXPECT_GT(luminance({1, 0, 0}), luminance({0, 0, 1}));
}

TEST(Vec3, FiniteMeansEveryElement) {
  EXPECT_TRUE(isFinite({1, -2, 0}));
  EXPECT_FALSE(isFinite({1, NAN, 0}));
  EXPECT_FALSE(isFinite({1, 0, -INFINITY}));
  EXPECT_FALSE(isFinite({INFINITY, 0, 0}));
}

TEST(Bounds, RaysThatMeetTheBox) {
  Bounds box;
  box.extend({0, 0, 0}), box.extend({1, 1, 1});
  EXPECT_TRUE(box.isHitBy({0.5f, 0.5f, 0.5f}, {0, 0, 1}));
  EXPECT_TRUE(box.isHitBy({0.5f, 0.5f, -1}, {0, 0, 1}));
  EXPECT_FALSE(box.isHitBy({0.5f, 0.5f, -1}, {0, 0, -1}));
  EXPECT_FALSE(box.isHitBy({1.5f, 0.5f, -1}, {0, 0, 1}));
  EXPECT_TRUE(box.isHitBy({2, 2, 2}, {-1, -1, -1}));
  EXPECT_FALSE(box.isHitBy({2, 2, 2}, {-1, -1, -0.2f}));
  EXPECT_TRUE(box.isHitBy({0.5f, 1, 0.5f}, {0, 1, 0}));  // its faces belong to it
}

TEST(Frame, IsOrthonormalAndRightHandedEverywhere) {
  for (const Vec3 n : manyDirections()) {
    const Frame b(n);
    EXPECT_NEAR(length(b.s), 1.0f, 1e-5f);
    EXPECT_NEAR(length(b.t), 1.0f, 1e-5f);
    EXPECT_NEAR(dot(b.s, b.t), 0.0f, 1e-5f);
    EXPECT_NEAR(dot(b.s, n), 0.0f, 1e-5f);
    EXPECT_NEAR(dot(b.t, n), 0.0f, 1e-5f);
    EXPECT_GT(dot(cross(b.s, b.t), n), 0.999f) << n.x << " " << n.y << " " << n.z;
    EXPECT_EQ(b.toWorld({0, 0, 1}), n);
  }
}

TEST(Bounds, GrowAndMeasure) {
  Bounds box;
  EXPECT_TRUE(box.empty());
  EXPECT_EQ(box.extent(), Vec3());
  box.extend(Vec3{1, 2, 3});
  EXPECT_FALSE(box.empty());
  EXPECT_EQ(box.diagonal(), 0.0f);
  Bounds other;
  other.extend(Vec3{3, 0, 3});
  box.extend(other);
  EXPECT_EQ(box.center(), Vec3(2, 1, 3));
  EXPECT_EQ(box.distanceSquared({2, 1, 3}), 0.0f);
  EXPECT_EQ(box.distanceSquared({5, 1, 0}), 13.0f);
}

}  // namespace
}  // namespace bnvpl
