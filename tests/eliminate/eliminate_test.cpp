// What the elimination stage promises about its result.
#include "tools/eliminate/eliminate.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "core/errors.h"
#include "core/random.h"
#include "spatial/morton_order.h"
#include "tests/eliminate/clouds.h"
#include "tools/eliminate/radii.h"

namespace bnvpl {
namespace {

EliminateOptions keep(uint64_t count, Density density = Density::Uniform) {
  EliminateOptions options;
  options.count = count;
  options.density = density;
  return options;
}

EliminateResult run(const Cloud& cloud, const EliminateOptions& options) {
  return eliminate(cloud.position, cloud.normal, options);
}

float smallestDistance(const Cloud& cloud, const std::vector<uint32_t>& rows) {
  float smallest = INFINITY;
  for (size_t a = 0; a < rows.size(); ++a) {
    for (size_t b = a + 1; b < rows.size(); ++b) {
      smallest = std::min(smallest, length(cloud.position[rows[a]] - cloud.position[rows[b]]));
    }
  }
  return smallest;
}

void expectSubset(const EliminateResult& result, size_t count, size_t candidates) {
  ASSERT_EQ(result.rows.size(), count);
  ASSERT_EQ(result.radius.size(), count);
  for (size_t i = 0; i < count; ++i) {
    ASSERT_LT(result.rows[i], candidates);
    // ascending, so unique too
    ASSERT_TRUE(i == 0 || result.rows[i - 1] < result.rows[i]);
    ASSERT_TRUE(std::isfinite(result.radius[i]) && result.radius[i] > 0.0f);
  }
}

TEST(Eliminate, KeepsExactlyTheCountInPathOrder) {
  const Cloud cloud = cube(1000, 2.0f, 1);
  for (const Density density : {Density::Uniform, Density::Local}) {
    for (const EliminationMethod method :
         {EliminationMethod::Elimination, EliminationMethod::Random}) {
      for (const uint64_t count : {1u, 2u, 200u, 999u, 1000u}) {
        EliminateOptions options = keep(count, density);
        options.method = method;
        expectSubset(run(cloud, options), count, cloud.size());
      }
    }
  }
}

TEST(Eliminate, SpacingFarBetterThanRandom) {
  const Cloud cloud = plane(5000, 1.0f, 1.0f, 2);
  EliminateOptions options = keep(1000);
  options.area = 1.0;
  for (const WeightLimiting limiting : {WeightLimiting::Auto, WeightLimiting::Off}) {
    options.weightLimiting = limiting;
    const EliminateResult result = run(cloud, options);
    EXPECT_NEAR(result.rMax, std::sqrt(1.0 / (2.0 * std::sqrt(3.0) * 1000.0)), 1e-9);
    EXPECT_GE(smallestDistance(cloud, result.rows) / (2.0 * result.rMax), 0.6);
  }
  options.method = EliminationMethod::Random;
  const EliminateResult random = run(cloud, options);
  EXPECT_LT(smallestDistance(cloud, random.rows) / (2.0 * random.rMax), 0.1);
}

// Relative to the local radius, the spacing is as good where candidates are dense as where they are
// not.
TEST(Eliminate, LocalDensitySpacesRelativeToTheRadius) {
  const Cloud cloud = unevenPlane(4000, 3);
  EliminateOptions options = keep(800, Density::Local);
  options.uniformShare = 0.0;
  const EliminateResult result = run(cloud, options);
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

// A tenth of the area holds half of the candidates: 0.8 * 400 + 0.2 * 80 of 800 VPLs.
TEST(Eliminate, AShareOfTheVplsIsSpentEvenly) {
  const Cloud cloud = unevenPlane(4000, 3);
  EliminateOptions options = keep(800, Density::Local);
  options.uniformShare = 0.2;
  const EliminateResult result = run(cloud, options);
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
  for (const Density density : {Density::Uniform, Density::Local}) {
    EXPECT_NEAR(run(flat, keep(4000, density)).area, 6.0, 0.6);
    EXPECT_NEAR(run(box, keep(4000, density)).area, 24.0, 2.4);
  }
}

// Of which a random part is looked at; in any order of theirs.
TEST(Eliminate, EstimatesTheAreaOfMany) {
  const Cloud flat = plane(500000, 3.0f, 2.0f, 4);
  EliminateOptions options = keep(1000, Density::Uniform);
  EXPECT_NEAR(candidateRadii(flat.position, flat.normal, options).area, 6.0, 0.1);
  Cloud sorted;
  for (const uint32_t i : mortonOrder(flat.position)) {
    sorted.position.push_back(flat.position[i]);
    sorted.normal.push_back(flat.normal[i]);
  }
  EXPECT_NEAR(candidateRadii(sorted.position, sorted.normal, options).area, 6.0, 0.1);
}

TEST(Eliminate, RadiiStandForTheArea) {
  const Cloud cloud = unevenPlane(20000, 6);
  EliminateOptions options = keep(4000, Density::Local);
  for (const double given : {0.0, 2.0}) {
    options.area = given;
    const EliminateResult result = run(cloud, options);
    double sum = 0.0;
    for (const float r : result.radius) sum += 2.0 * std::sqrt(3.0) * r * r;
    EXPECT_NEAR(sum / result.area, 1.0, 0.1);
    EXPECT_NEAR(result.area, given > 0.0 ? given : 1.0, 0.1);
  }
}

// Both sides are kept as if the other was not there, although they are much nearer than r_max.
TEST(Eliminate, TwoSidesOfAThinSheetDoNotCompete) {
  Cloud sheet = plane(2000, 1.0f, 1.0f, 7);
  const Cloud alone = sheet;
  for (size_t i = 0; i < 2000; ++i) sheet.add(alone.position[i] - Vec3(0, 0, 1e-3f), {0, 0, -1});
  for (const Density density : {Density::Uniform, Density::Local}) {
    const EliminateResult result = run(sheet, keep(800, density));
    EXPECT_NEAR(result.area / run(alone, keep(400, density)).area, 2.0, 0.01);
    size_t front = 0;
    for (const uint32_t row : result.rows) front += row < 2000;
    // The two sides are equal but for the numbers that break ties.
    EXPECT_NEAR(static_cast<double>(front), 400.0, 1.0);
  }
}

TEST(Eliminate, StackedSheetsDoNotCompete) {
  Cloud shelves = plane(2000, 1.0f, 1.0f, 8);
  for (size_t i = 0; i < 2000; ++i) {
    shelves.add(shelves.position[i] + Vec3(0, 0, 0.1f), {0, 0, 1});
  }
  const EliminateResult result = run(shelves, keep(800));
  EXPECT_NEAR(result.area, 2.0, 0.2);
  size_t lower = 0;
  for (const uint32_t row : result.rows) lower += row < 2000;
  EXPECT_NEAR(static_cast<double>(lower), 400.0, 1.0);
}

TEST(Eliminate, AnyNumberOfThreadsGivesTheSame) {
  const Cloud cloud = cube(10000, 1.0f, 9);
  for (const Density density : {Density::Uniform, Density::Local}) {
    for (const EliminationMethod method :
         {EliminationMethod::Elimination, EliminationMethod::Random}) {
      EliminateOptions options = keep(2000, density);
      options.method = method;
      std::vector<EliminateResult> results;
      for (const size_t threads : {1u, 2u, 7u}) {
        tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        results.push_back(run(cloud, options));
      }
      for (const EliminateResult& result : results) {
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
  for (const Density density : {Density::Uniform, Density::Local}) {
    const EliminateResult result = run(cloud, keep(50, density));
    expectSubset(result, 50, 500);
    EXPECT_EQ(result.rows.back(), 49u);  // of equals, the lower rows stay
  }
}

TEST(Eliminate, ManyCandidatesAtFewPlaces) {
  Cloud cloud;
  for (int i = 0; i < 900; ++i) cloud.add({static_cast<float>(i % 3), 0, 0}, {0, 1, 0});
  for (const Density density : {Density::Uniform, Density::Local}) {
    const EliminateResult result = run(cloud, keep(3, density));
    EXPECT_EQ(result.rows, (std::vector<uint32_t>{0, 1, 2}));
  }
}

TEST(Eliminate, OneCandidate) {
  Cloud cloud;
  cloud.add({5, 5, 5}, {0, 0, 1});
  for (const Density density : {Density::Uniform, Density::Local}) {
    expectSubset(run(cloud, keep(1, density)), 1, 1);
  }
}

TEST(Eliminate, RandomDependsOnTheSeed) {
  const Cloud cloud = plane(1000, 1.0f, 1.0f, 10);
  EliminateOptions options = keep(300);
  options.method = EliminationMethod::Random;
  const EliminateResult first = run(cloud, options);
  options.seed = 2;
  EXPECT_NE(first.rows, run(cloud, options).rows);
  EXPECT_EQ(first.rMax, run(cloud, keep(300)).rMax);
  double mean = 0.0;
  for (const uint32_t row : first.rows) mean += row / 300.0;
  EXPECT_NEAR(mean, 499.5, 4.0 * 289.0 / std::sqrt(300.0));
}

TEST(Eliminate, TooManyWantedSaysWhatToRerun) {
  const Cloud cloud = plane(100, 1.0f, 1.0f, 11);
  try {
    run(cloud, keep(200));
    FAIL();
  } catch (const InputError& e) {
    const std::string text = e.what();
    EXPECT_NE(text.find("100 candidates"), std::string::npos) << text;
    EXPECT_NE(text.find("rerun vpl-place -n at least 1000"), std::string::npos) << text;
  }
  EXPECT_THROW(run(cloud, keep(0)), InputError);
}

}  // namespace
}  // namespace bnvpl
