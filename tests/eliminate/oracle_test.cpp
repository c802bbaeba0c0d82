// Elimination against the sequential greedy algorithm in its plainest form.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <set>

#include "core/random.h"
#include "tests/eliminate/keep.h"
#include "tools/eliminate/elimination/conflict_graph.h"
#include "tools/eliminate/elimination/greedy.h"

namespace bnvpl {
namespace {

// The weight of every pair, in units of 2^-40, computed straight from the definition.
std::vector<std::vector<uint64_t>> allPairs(const Cloud& cloud, const std::vector<float>& radius,
                                            const PairWeight& rule) {
  const size_t n = cloud.size();
  std::vector<std::vector<uint64_t>> weight(n, std::vector<uint64_t>(n, 0));
  for (size_t i = 0; i < n; ++i) {
    for (size_t j = 0; j < n; ++j) {
      const Vec3 offset = cloud.position[j] - cloud.position[i];
      const float reach = radius[i] + radius[j], distance = length(offset);
      const bool sameSide = dot(cloud.normal[i], cloud.normal[j]) >= 0.5f;
      const bool samePlane = std::fabs(dot(offset, cloud.normal[i])) <= 0.5f * reach &&
                             std::fabs(dot(offset, cloud.normal[j])) <= 0.5f * reach;
      if (i == j || distance >= reach || !sameSide || !samePlane) continue;
      const float x = 1.0f - std::max(distance / reach, rule.limit), x2 = x * x;
      const float pair = rule.alpha == 8.0f ? x2 * x2 * (x2 * x2) : std::pow(x, rule.alpha);
      weight[i][j] = static_cast<uint64_t>(pair * 0x1p40f);
    }
  }
  return weight;
}

// Repeatedly removes the heaviest remaining candidate and updates the sums of the others.
std::vector<uint32_t> greedyOracle(const Cloud& cloud, const std::vector<float>& radius,
                                   size_t keep, const PairWeight& rule = {}) {
  const size_t n = cloud.size();
  const auto weight = allPairs(cloud, radius, rule);
  std::vector<uint64_t> sum(n, 0);
  for (size_t i = 0; i < n; ++i) {
    for (size_t j = 0; j < n; ++j) sum[i] += weight[i][j];
  }
  std::vector<bool> alive(n, true);
  for (size_t left = n; left > keep; --left) {
    size_t heaviest = n;
    for (size_t i = 0; i < n; ++i) {  // among equal sums, the later row is removed
      if (alive[i] && (heaviest == n || sum[i] >= sum[heaviest])) heaviest = i;
    }
    alive[heaviest] = false;
    for (size_t j = 0; j < n; ++j) sum[j] -= weight[heaviest][j];
  }
  std::vector<uint32_t> rows;
  for (size_t i = 0; i < n; ++i) {
    if (alive[i]) rows.push_back(static_cast<uint32_t>(i));
  }
  return rows;
}

// Radius of every candidate when `count` are kept, derived from a run that keeps all of them.
std::vector<float> radiusOfAll(const Cloud& cloud, size_t count) {
  std::vector<float> radius =
      keepRowsOf(cloud, with(keep(cloud.size(), "local"), {{"method", "random"}})).radius;
  const double wider = std::sqrt(static_cast<double>(cloud.size()) / static_cast<double>(count));
  for (float& r : radius) r = static_cast<float>(r * wider);
  return radius;
}

Cloud withDuplicates(Cloud cloud) {
  for (size_t i = 0; i < 60; ++i) cloud.add(cloud.position[i * 3], cloud.normal[i * 3]);
  for (size_t i = 0; i < 12; ++i) cloud.add(cloud.position[0], cloud.normal[0]);
  return cloud;
}

TEST(Oracle, UniformOnPlaneAndCube) {
  for (const uint64_t seed : {1u, 2u, 3u}) {
    for (const Cloud& cloud : {plane(500, 2.0f, 1.0f, seed), cube(600, 3.0f, seed)}) {
      const KeptRows result = keepRowsOf(cloud, keep(100));
      const std::vector<float> radius(cloud.size(), static_cast<float>(result.rMax));
      EXPECT_EQ(result.rows, greedyOracle(cloud, radius, 100));
    }
  }
}

TEST(Oracle, LocalDensity) {
  for (const uint64_t seed : {4u, 5u, 6u}) {
    for (const Cloud& cloud : {unevenPlane(500, seed), cube(600, 1.0f, seed)}) {
      const KeptRows result = keepRowsOf(cloud, keep(90, "local"));
      const std::vector<float> radius = radiusOfAll(cloud, 90);
      for (size_t i = 0; i < result.rows.size(); ++i) {
        ASSERT_NEAR(result.radius[i] / radius[result.rows[i]], 1.0f, 1e-5f);
      }
      EXPECT_EQ(result.rows, greedyOracle(cloud, radius, 90));
    }
  }
}

TEST(Oracle, TiesGoToTheLowerRow) {
  const Cloud cloud = withDuplicates(cube(400, 2.0f, 7));
  for (const uint64_t count : {380u, 100u, 20u, 3u}) {
    const KeptRows result = keepRowsOf(cloud, keep(count));
    const std::vector<float> radius(cloud.size(), static_cast<float>(result.rMax));
    EXPECT_EQ(result.rows, greedyOracle(cloud, radius, count)) << count;
  }
}

// On a lattice nearly every weight occurs many times, so ties are frequent.
TEST(Oracle, RegularLattice) {
  Cloud cloud;
  for (int x = 0; x < 20; ++x) {
    for (int y = 0; y < 20; ++y) {
      cloud.add({static_cast<float>(x), static_cast<float>(y), 0.0f}, {0, 0, 1});
    }
  }
  const KeptRows result =
      keepRowsOf(cloud, with(keep(80), {{"area", "400"}, {"weight-limiting", "off"}}));
  const std::vector<float> radius(cloud.size(), static_cast<float>(result.rMax));
  EXPECT_EQ(result.rows, greedyOracle(cloud, radius, 80));
}

TEST(Oracle, WeightLimitingOnlyWhereTheAreaIsKnown) {
  const Cloud cloud = plane(500, 1.0f, 1.0f, 8);
  const Given options = with(keep(100), {{"area", "1"}});
  const KeptRows result = keepRowsOf(cloud, options);
  const std::vector<float> radius(cloud.size(), static_cast<float>(result.rMax));
  const auto limit = static_cast<float>(0.65 * (1.0 - std::pow(0.2, 1.5)));
  EXPECT_EQ(result.rows, greedyOracle(cloud, radius, 100, {8.0f, limit}));
  EXPECT_EQ(keepRowsOf(cloud, with(options, {{"weight-limiting", "off"}})).rows,
            greedyOracle(cloud, radius, 100));
  const KeptRows estimated = keepRowsOf(cloud, with(keep(100), {{"weight-limiting", "on"}}));
  EXPECT_EQ(estimated.rows,
            greedyOracle(cloud, std::vector<float>(cloud.size(), float(estimated.rMax)), 100,
                         {8.0f, limit}));
}

TEST(Oracle, AnyExponent) {
  const Cloud cloud = plane(500, 1.0f, 1.0f, 8);
  std::set<std::vector<uint32_t>> kept;
  for (const float alpha : {1.0f, 2.5f, 8.0f, 12.0f}) {
    const KeptRows result = keepRowsOf(cloud, with(keep(100), {{"alpha", std::to_string(alpha)}}));
    const std::vector<float> radius(cloud.size(), static_cast<float>(result.rMax));
    EXPECT_EQ(result.rows, greedyOracle(cloud, radius, 100, {alpha, 0.0f})) << alpha;
    kept.insert(result.rows);
  }
  EXPECT_EQ(kept.size(), 4u);
}

// The candidates fill many blocks and cells of many sizes; removed nodes are dropped meanwhile.
TEST(Oracle, ManyCandidatesOfDensitiesFarApart) {
  Cloud cloud = unevenPlane(3000, 13);
  for (size_t i = 0; i < 500; ++i) {  // a dense cluster of them
    cloud.add(cloud.position[7] + (cloud.position[i] - cloud.position[7]) * 1e-3f, cloud.normal[i]);
  }
  for (const std::string density : kDensities) {
    const KeptRows result = keepRowsOf(cloud, keep(100, density));
    const std::vector<float> radius =
        density == "local" ? radiusOfAll(cloud, 100)
                           : std::vector<float>(cloud.size(), static_cast<float>(result.rMax));
    EXPECT_EQ(result.rows, greedyOracle(cloud, radius, 100));
  }
}

// Sum of the power of the lowest 24 frequencies of points on the unit square, over that of random
// points.
double lowFrequencyPower(const Cloud& cloud, const std::vector<uint32_t>& rows) {
  double power = 0.0;
  int frequencies = 0;
  for (int u = 0; u <= 3; ++u) {
    for (int v = u > 0 ? -3 : 1; v <= 3; ++v, ++frequencies) {
      double re = 0.0, im = 0.0;
      for (const uint32_t row : rows) {
        const double angle =
            2.0 * M_PI * (u * double{cloud.position[row].x} + v * double{cloud.position[row].y});
        re += std::cos(angle), im += std::sin(angle);
      }
      power += (re * re + im * im) / double(rows.size());
    }
  }
  return power / frequencies;
}

struct Spacing {
  double mean = 0.0, smallest = INFINITY;  // distance of the nearest over the sum of radii
};
Spacing spacingOf(const Cloud& cloud, const KeptRows& kept) {
  Spacing spacing;
  for (size_t a = 0; a < kept.rows.size(); ++a) {
    double nearest = INFINITY;
    for (size_t b = 0; b < kept.rows.size(); ++b) {
      if (a == b) continue;
      const float d = length(cloud.position[kept.rows[a]] - cloud.position[kept.rows[b]]);
      nearest = std::min(nearest, double{d / (kept.radius[a] + kept.radius[b])});
    }
    spacing.mean += nearest / double(kept.rows.size());
    spacing.smallest = std::min(spacing.smallest, nearest);
  }
  return spacing;
}

// 40 candidates per VPL are eliminated in steps. The result is as well spread as that of one step.
TEST(Oracle, StepsKeepTheSpacing) {
  for (const bool uneven : {false, true}) {
    const Cloud cloud = uneven ? unevenPlane(24000, 5) : plane(24000, 1.0f, 1.0f, 5);
    const KeptRows steps = keepRowsOf(cloud, keep(600, "local"));
    const std::vector<float> radius = radiusOfAll(cloud, 600);
    std::vector<uint32_t> row(cloud.size());
    std::iota(row.begin(), row.end(), 0u);
    ConflictGraph graph(cloud.position, cloud.normal, radius, row, PairWeight{});
    KeptRows exact;
    exact.rows = eliminateHeaviest(graph, 600);
    for (const uint32_t r : exact.rows) exact.radius.push_back(radius[r]);
    EXPECT_NE(std::set(steps.rows.begin(), steps.rows.end()),
              std::set(exact.rows.begin(), exact.rows.end()));
    const Spacing few = spacingOf(cloud, steps), all = spacingOf(cloud, exact);
    EXPECT_GT(few.mean / all.mean, 0.98);
    EXPECT_GT(few.smallest / all.smallest, 0.95);
    if (!uneven) {
      EXPECT_LT(lowFrequencyPower(cloud, steps.rows), 0.25);
      EXPECT_LT(lowFrequencyPower(cloud, exact.rows), 0.25);
    }
  }
}

}  // namespace
}  // namespace bnvpl
