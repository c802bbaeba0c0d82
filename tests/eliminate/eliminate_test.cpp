// Guarantees of the elimination stage about its result.
#include "tools/eliminate/eliminate.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <ctime>

#include "core/errors.h"
#include "core/random.h"
#include "spatial/morton_order.h"
#include "tests/eliminate/keep.h"
#include "tests/support/threads.h"
#include "tools/eliminate/radii.h"

namespace bnvpl {
namespace {

float smallestDistance(const Cloud& cloud, const std::vector<uint32_t>& rows) {
  float smallest = INFINITY;
  for (size_t a = 0; a < rows.size(); ++a) {
    for (size_t b = a + 1; b < rows.size(); ++b) {
      smallest = std::min(smallest, length(cloud.position[rows[a]] - cloud.position[rows[b]]));
    }
  }
  return smallest;
}

void expectSubset(const KeptRows& result, size_t count, size_t candidates) {
  ASSERT_EQ(result.rows.size(), count);
  ASSERT_EQ(result.radius.size(), count);
  for (size_t i = 0; i < count; ++i) {
    ASSERT_LT(result.rows[i], candidates);
    // The rows ascend, so they are unique.
    ASSERT_TRUE(i == 0 || result.rows[i - 1] < result.rows[i]);
    ASSERT_TRUE(std::isfinite(result.radius[i]) && result.radius[i] > 0.0f);
  }
}

TEST(Eliminate, KeepsExactlyTheCountInPathOrder) {
  const Cloud cloud = cube(1000, 2.0f, 1);
  for (const char* density : kDensities) {
    for (const char* method : {"elimination", "random"}) {
      for (const uint64_t count : {1u, 2u, 200u, 999u, 1000u}) {
        const Given options = with(keep(count, density), {{"method", method}});
        expectSubset(keepRowsOf(cloud, options), count, cloud.size());
      }
    }
  }
}

TEST(Eliminate, SpacingFarBetterThanRandom) {
  const Cloud cloud = plane(5000, 1.0f, 1.0f, 2);
  const Given options = with(keep(1000), {{"area", "1"}});
  for (const char* limiting : {"auto", "off"}) {
    const KeptRows result = keepRowsOf(cloud, with(options, {{"weight-limiting", limiting}}));
    EXPECT_NEAR(result.rMax, std::sqrt(1.0 / (2.0 * std::sqrt(3.0) * 1000.0)), 1e-9);
    EXPECT_GE(smallestDistance(cloud, result.rows) / (2.0 * result.rMax), 0.6);
  }
  const KeptRows random = keepRowsOf(cloud, with(options, {{"method", "random"}}));
  EXPECT_LT(smallestDistance(cloud, random.rows) / (2.0 * random.rMax), 0.1);
}

// Relative to the local radius, the spacing is equally good in dense and in sparse regions.
TEST(Eliminate, LocalDensitySpacesRelativeToTheRadius) {
  const Cloud cloud = unevenPlane(4000, 3);
  const KeptRows result = keepRowsOf(cloud, with(keep(800, "local"), {{"uniform-share", "0"}}));
  size_t dense = 0;
  for (size_t a = 0; a < result.rows.size(); ++a) {
    if (cloud.position[result.rows[a]].x < 0.1f) ++dense;
    for (size_t b = a + 1; b < result.rows.size(); ++b) {
      const float d = length(cloud.position[result.rows[a]] - cloud.position[result.rows[b]]);
      ASSERT_GT(d, 0.45f * (result.radius[a] + result.radius[b]));
    }
  }
  EXPECT_NEAR(static_cast<double>(dense), 400.0, 40.0);  // half of the candidates lie there
}

// A tenth of the area holds half of the candidates: of 800 VPLs it gets 0.8 * 400 + 0.2 * 80.
TEST(Eliminate, AShareOfTheVplsIsSpentEvenly) {
  const Cloud cloud = unevenPlane(4000, 3);
  const KeptRows result = keepRowsOf(cloud, with(keep(800, "local"), {{"uniform-share", "0.2"}}));
  double dense = 0.0;
  float largest = 0.0f;
  for (size_t a = 0; a < result.rows.size(); ++a) {
    if (cloud.position[result.rows[a]].x < 0.1f) dense += 1.0;
    largest = std::max(largest, result.radius[a]);
  }
  EXPECT_NEAR(dense, 336.0, 35.0);
  EXPECT_LT(largest, result.rMax / std::sqrt(0.2) * 1.001);
}

TEST(Eliminate, EstimatesTheArea) {
  const Cloud flat = plane(20000, 3.0f, 2.0f, 4), box = cube(20000, 2.0f, 5);
  for (const char* density : kDensities) {
    EXPECT_NEAR(keepRowsOf(flat, keep(4000, density)).area, 6.0, 0.6);
    EXPECT_NEAR(keepRowsOf(box, keep(4000, density)).area, 24.0, 2.4);
  }
}

// The area is estimated from a random part of many candidates; their order does not matter.
TEST(Eliminate, EstimatesTheAreaOfMany) {
  const Cloud flat = plane(500000, 3.0f, 2.0f, 4);
  const Values options = resolve(eliminateSpec(), keep(1000));
  EXPECT_NEAR(candidateRadii(flat.position, flat.normal, 1000, options).area, 6.0, 0.1);
  Cloud sorted;
  for (const uint32_t i : mortonOrder(flat.position)) {
    sorted.position.push_back(flat.position[i]);
    sorted.normal.push_back(flat.normal[i]);
  }
  EXPECT_NEAR(candidateRadii(sorted.position, sorted.normal, 1000, options).area, 6.0, 0.1);
}

// Every preparation before the first removal reports its progress and counts to its end.
TEST(Eliminate, ReportsItsPreparations) {
  const Cloud flat = plane(20000, 3.0f, 2.0f, 4);
  std::vector<std::string> names;
  uint64_t total = 0;
  std::atomic<uint64_t> done{0};
  const ProgressFn progress([&](uint64_t units) { done += units; },
                            [&](std::string_view what, uint64_t of) {
                              names.emplace_back(what);
                              total = of;
                              done = 0;
                            },
                            [&] { EXPECT_EQ(done, total) << names.back(); });
  VplTable candidates;
  candidates.position = flat.position;
  candidates.normal = flat.normal;
  candidates.albedo.assign(flat.position.size(), Vec3(0.5f));
  candidates.id.resize(flat.position.size());
  eliminate(candidates, resolve(eliminateSpec(), keep(1000, "local")), nullptr, nullptr, progress);
  EXPECT_EQ(names, (std::vector<std::string>{"radii, candidates", "conflict weights"}));
}

TEST(Eliminate, RadiiStandForTheArea) {
  const Cloud cloud = unevenPlane(20000, 6);
  for (const double given : {0.0, 2.0}) {
    const KeptRows result =
        keepRowsOf(cloud, with(keep(4000, "local"), {{"area", std::to_string(given)}}));
    double sum = 0.0;
    for (const float r : result.radius) sum += 2.0 * std::sqrt(3.0) * r * r;
    EXPECT_NEAR(sum / result.area, 1.0, 0.1);
    EXPECT_NEAR(result.area, given > 0.0 ? given : 1.0, 0.1);
  }
}

// Each side keeps what it would keep alone, although the sides are much nearer than r_max.
TEST(Eliminate, TwoSidesOfAThinSheetDoNotCompete) {
  Cloud sheet = plane(2000, 1.0f, 1.0f, 7);
  const Cloud alone = sheet;
  for (size_t i = 0; i < 2000; ++i) sheet.add(alone.position[i] - Vec3(0, 0, 1e-3f), {0, 0, -1});
  for (const char* density : kDensities) {
    const KeptRows result = keepRowsOf(sheet, keep(800, density));
    EXPECT_NEAR(result.area / keepRowsOf(alone, keep(400, density)).area, 2.0, 0.01);
    size_t front = 0;
    for (const uint32_t row : result.rows) front += row < 2000;
    // The sides differ only in the random numbers that break ties.
    EXPECT_NEAR(static_cast<double>(front), 400.0, 1.0);
  }
}

TEST(Eliminate, StackedSheetsDoNotCompete) {
  Cloud shelves = plane(2000, 1.0f, 1.0f, 8);
  for (size_t i = 0; i < 2000; ++i) {
    shelves.add(shelves.position[i] + Vec3(0, 0, 0.1f), {0, 0, 1});
  }
  const KeptRows result = keepRowsOf(shelves, keep(800));
  EXPECT_NEAR(result.area, 2.0, 0.2);
  size_t lower = 0;
  for (const uint32_t row : result.rows) lower += row < 2000;
  EXPECT_NEAR(static_cast<double>(lower), 400.0, 1.0);
}

TEST(Eliminate, AnyNumberOfThreadsGivesTheSame) {
  const Cloud cloud = cube(10000, 1.0f, 9);
  for (const char* density : kDensities) {
    for (const char* method : {"elimination", "random"}) {
      const Given options = with(keep(2000, density), {{"method", method}});
      std::vector<KeptRows> results;
      for (const size_t threads : {1u, 2u, 7u})
        results.push_back(test::withThreads(threads, [&] { return keepRowsOf(cloud, options); }));
      for (const KeptRows& result : results) {
        EXPECT_EQ(result.rows, results[0].rows);
        EXPECT_EQ(result.radius, results[0].radius);
        EXPECT_EQ(result.rMax, results[0].rMax);
        EXPECT_EQ(result.area, results[0].area);
      }
    }
  }
}

TEST(Eliminate, AllCandidatesAtOnePlace) {
  Cloud cloud;
  for (int i = 0; i < 500; ++i) cloud.add({1.0f, 2.0f, 3.0f}, {0, 1, 0});
  for (const char* density : kDensities) {
    const KeptRows result = keepRowsOf(cloud, keep(50, density));
    expectSubset(result, 50, 500);
    EXPECT_EQ(result.rows.back(), 49u);  // among equals, the lower rows stay
  }
}

TEST(Eliminate, ManyCandidatesAtFewPlaces) {
  Cloud cloud;
  for (int i = 0; i < 900; ++i) cloud.add({static_cast<float>(i % 3), 0, 0}, {0, 1, 0});
  for (const char* density : kDensities) {
    const KeptRows result = keepRowsOf(cloud, keep(3, density));
    EXPECT_EQ(result.rows, (std::vector<uint32_t>{0, 1, 2}));
  }
}

TEST(Eliminate, OneCandidate) {
  Cloud cloud;
  cloud.add({5, 5, 5}, {0, 0, 1});
  for (const char* density : kDensities) {
    expectSubset(keepRowsOf(cloud, keep(1, density)), 1, 1);
  }
}

TEST(Eliminate, RandomDependsOnTheSeed) {
  const Cloud cloud = plane(1000, 1.0f, 1.0f, 10);
  const Given options = with(keep(300), {{"method", "random"}});
  const KeptRows first = keepRowsOf(cloud, options);
  EXPECT_NE(first.rows, keepRowsOf(cloud, with(options, {{"seed", "2"}})).rows);
  EXPECT_EQ(first.rMax, keepRowsOf(cloud, keep(300)).rMax);
  double mean = 0.0;
  for (const uint32_t row : first.rows) mean += row / 300.0;
  EXPECT_NEAR(mean, 499.5, 4.0 * 289.0 / std::sqrt(300.0));
}

TEST(Eliminate, TooManyWantedSaysWhatToRerun) {
  const Cloud cloud = plane(100, 1.0f, 1.0f, 11);
  try {
    keepRowsOf(cloud, keep(200));
    FAIL();
  } catch (const InputError& e) {
    const std::string text = e.what();
    EXPECT_NE(text.find("100 candidates"), std::string::npos) << text;
    EXPECT_NE(text.find("rerun vpl-place -n 4000"), std::string::npos) << text;
  }
  EXPECT_THROW(keepRowsOf(cloud, keep(0)), UsageError);
}

// A single step costs candidates^2 / kept: 75 times as much for 20 as for 1500. Keeping few in
// several steps bounds the time.
TEST(Eliminate, TimeDoesNotRiseAsFewerAreKept) {
  const Cloud cloud = cube(60000, 1.0f, 12);
  const auto cpuTicks = [&](uint64_t count) {
    const std::clock_t begin = std::clock();
    expectSubset(keepRowsOf(cloud, keep(count)), count, cloud.size());
    return static_cast<double>(std::clock() - begin);
  };
  const double many = cpuTicks(1500);
  for (const uint64_t count : {200u, 20u, 1u}) EXPECT_LT(cpuTicks(count), 4.0 * many) << count;
}

// Keeping few of many in several steps costs little of the spacing.
TEST(Eliminate, SpacingOfFewOfMany) {
  const Cloud cloud = plane(60000, 1.0f, 1.0f, 13);
  const KeptRows result = keepRowsOf(cloud, with(keep(200), {{"area", "1"}}));
  EXPECT_GE(smallestDistance(cloud, result.rows) / (2.0 * result.rMax), 0.6);
}

TEST(Eliminate, ProgressAddsUpToTheCandidates) {
  const VplTable table = tableOf(cube(20000, 1.0f, 14));
  for (const char* count : {"1", "500", "19999", "20000"}) {
    std::atomic<uint64_t> done{0};
    int calls = 0;
    bool preparing = false;
    const ProgressFn progress(
        [&](uint64_t more) {
          if (preparing) return;
          done += more;
          ++calls;
          EXPECT_LE(done, table.size());
        },
        [&](std::string_view, uint64_t) { preparing = true; }, [&] { preparing = false; });
    eliminate(table, resolve(eliminateSpec(), {{"count", count}}), nullptr, nullptr, progress);
    EXPECT_EQ(done, table.size()) << count;
    EXPECT_GT(calls, count == std::string("1") ? 10 : 0);
  }
}

}  // namespace
}  // namespace bnvpl
