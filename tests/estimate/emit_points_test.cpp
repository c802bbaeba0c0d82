// Emission points of VPLs are drawn in proportion to the light that arrives at them.
#include "tools/estimate/emit_points.h"

#include <gtest/gtest.h>

#include <array>

namespace bnvpl {
namespace {

constexpr size_t kDraws = 20000;
constexpr std::array kWeights{0.5, 2.0, 0.0, 1.5};

SurfacePoint hitAt(float x) {
  SurfacePoint hit;
  hit.position = {x, 0.25f, -1.0f};
  hit.ng = {0, 1, 0};
  return hit;
}

const VplTable& manyVpls() {
  static const VplTable vpls = [] {
    VplTable table;
    table.position.resize(kDraws);
    table.radius.resize(kDraws, 0.5f);
    return table;
  }();
  return vpls;
}

// Draws emission points for each of many VPLs, from hits `begin` to `end` of the same four.
EmitPoints raced(size_t begin = 0, size_t end = kWeights.size(), uint64_t key = 7,
                 size_t perVpl = 1) {
  EmitPoints points(manyVpls(), perVpl, key);
  for (size_t vpl = 0; vpl < kDraws; ++vpl) {
    for (size_t h = begin; h < end; ++h) points.offer(vpl, kWeights[h], hitAt(float(h)));
  }
  return points;
}

std::array<double, 4> sharesOf(const EmitPoints& points) {
  std::array<double, 4> shares{};
  for (const EmitPoint& p : points.winners()) shares[size_t(p.position.x)] += 1.0 / kDraws;
  return shares;
}

TEST(EmitPoints, AreDrawnInProportionToTheLight) {
  const auto shares = sharesOf(raced());
  for (size_t h = 0; h < 4; ++h) {
    const double expected = kWeights[h] / 4.0;
    EXPECT_NEAR(shares[h], expected, 4.0 * std::sqrt(expected * (1.0 - expected) / kDraws)) << h;
  }
}

// Each of several points has these shares, and any two of them are independent.
TEST(EmitPoints, OfOneVplAreIndependent) {
  constexpr size_t kPoints = 5;
  const EmitPoints points = raced(0, kWeights.size(), 7, kPoints);
  const auto hitOf = [&](size_t vpl, size_t k) {
    return size_t(points.winners()[vpl * kPoints + k].position.x);
  };
  const auto expectShare = [](double share, double expected, size_t k) {
    EXPECT_NEAR(share, expected, 4.5 * std::sqrt(expected * (1.0 - expected) / kDraws)) << k;
  };
  for (size_t k = 0; k < kPoints; ++k) {
    std::array<double, 4> shares{};
    double both = 0.0;
    for (size_t vpl = 0; vpl < kDraws; ++vpl) {
      shares[hitOf(vpl, k)] += 1.0 / kDraws;
      both += (hitOf(vpl, k) == 1 && hitOf(vpl, (k + 1) % kPoints) == 3) / double(kDraws);
    }
    for (const size_t h : {0u, 1u, 3u}) expectShare(shares[h], kWeights[h] / 4.0, k);
    expectShare(both, 0.5 * 0.375, k);
  }
}

TEST(EmitPoints, MergeLikeTheWhole) {
  for (const size_t perVpl : {1u, 16u}) {
    const EmitPoints whole = raced(0, 4, 7, perVpl);
    for (const size_t middle : {1u, 3u}) {
      EmitPoints behind = raced(middle, 4, 7, perVpl);
      const EmitPoints before = raced(0, middle, 7, perVpl);
      behind.add(before.winners());
      for (size_t i = 0; i < whole.winners().size(); ++i)
        ASSERT_EQ(behind.winners()[i].position, whole.winners()[i].position);
    }
  }
}

// Hits of both ways to estimate compete by their light: 2.5 with 1.5.
TEST(EmitPoints, OfOthersCompeteByTheirLight) {
  EmitPoints points = raced(3, 4);
  points.add(raced(0, 3, 8).winners());
  EXPECT_NEAR(sharesOf(points)[3], 1.5 / (1.5 + 2.5), 4.0 * std::sqrt(0.25 / kDraws));
}

TEST(EmitPoints, WithoutLightAreThePositionOfTheVpl) {
  VplTable lit;
  lit.position = {{1, 2, 3}, {4, 5, 6}};
  lit.normal = {{0, 0, 1}, {1, 0, 0}};
  lit.radius = {1, 1};
  EmitPoints points(lit, 3, 7);
  points.offer(0, 1.0, hitAt(8.0f));
  points.fill(lit);
  ASSERT_EQ(lit.emitPoints, 3u);
  ASSERT_EQ(lit.emitPosition.size(), 6u);
  EXPECT_EQ(lit.emitPosition[2], Vec3(8.0f, 0.25f, -1.0f));
  EXPECT_EQ(lit.emitNormal[2], Vec3(0, 1, 0));
  EXPECT_EQ(lit.emitPosition[3], Vec3(4, 5, 6));
  EXPECT_EQ(lit.emitNormal[5], Vec3(1, 0, 0));
}

}  // namespace
}  // namespace bnvpl
