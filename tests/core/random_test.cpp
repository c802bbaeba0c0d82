#include "core/random.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>
#include <vector>

#include "core/random_streams.h"

namespace bnvpl {
namespace {

TEST(Random, UnitFloatNeverReachesOne) {
  EXPECT_EQ(toUnitFloat(0), 0.0f);
  EXPECT_LT(toUnitFloat(~uint64_t{0}), 1.0f);
  EXPECT_GT(toUnitFloat(~uint64_t{0}), 0.9999999f);
}

TEST(Random, DependsOnKeyIndexAndDimensionOnly) {
  Rng a(streamKey(1, RandomStream::Photons), 5), b(streamKey(1, RandomStream::Photons), 5);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(a.next(), b.next());
  EXPECT_EQ(random64(3, 4, 5), random64(3, 4, 5));
  std::set<uint64_t> seen;
  for (uint64_t key = 0; key < 10; ++key) {
    for (uint64_t index = 0; index < 10; ++index) {
      for (uint32_t dimension = 0; dimension < 10; ++dimension) {
        seen.insert(random64(key, index, dimension));
      }
    }
  }
  EXPECT_EQ(seen.size(), 1000u);
}

TEST(Random, StreamsAndSeedsShareNoKey) {
  std::set<uint64_t> keys;
  for (uint64_t seed = 0; seed < 1000; ++seed) {
    for (const RandomStream s :
         {RandomStream::PlaceCamera, RandomStream::PlaceLight, RandomStream::Eliminate,
          RandomStream::Photons, RandomStream::PixelSamples, RandomStream::LightTree,
          RandomStream::Plot, RandomStream::AreaEstimate, RandomStream::LightTracer,
          RandomStream::FilmPoints, RandomStream::VplPaths}) {
      keys.insert(streamKey(seed, s));
    }
  }
  EXPECT_EQ(keys.size(), 11000u);
}

// Any 256 consecutive points, counted from a multiple of 256, put one point into each elementary
// interval of area 1/256, for any key.
TEST(Random, SobolPointsFillEveryBoxOnce) {
  std::set<float> firsts;
  for (const uint64_t key : {0u, 1u, 77u}) {
    firsts.insert(owenSobol(0, key).x);
    for (const uint32_t begin : {0u, 256u, 0xffffff00u}) {
      for (uint32_t columns = 1; columns <= 256; columns *= 2) {
        const uint32_t rows = 256 / columns;
        std::set<uint32_t> boxes;
        for (uint32_t i = 0; i < 256; ++i) {
          const Point2 p = owenSobol(begin + i, key);
          boxes.insert(static_cast<uint32_t>(p.y * static_cast<float>(rows)) * columns +
                       static_cast<uint32_t>(p.x * static_cast<float>(columns)));
        }
        EXPECT_EQ(boxes.size(), 256u) << "key " << key << ", " << columns << " columns";
      }
    }
  }
  EXPECT_EQ(firsts.size(), 3u);
}

// Point i of one key is independent of point i of another. With one common order, one half of the
// first set would always meet the same half of the second.
TEST(Random, SobolPointsOfTwoKeysAreIndependent) {
  constexpr uint32_t kPoints = 256, kKeys = 64;
  double together = 0.0, squares = 0.0;
  for (uint64_t key = 0; key < kKeys; ++key) {
    double sum = 0.0;
    for (uint32_t i = 0; i < kPoints; ++i)
      sum += (owenSobol(i, key).x < 0.5f) == (owenSobol(i, key + 1000).x < 0.5f) ? 1.0 : -1.0;
    together += sum / kPoints, squares += (sum / kPoints) * (sum / kPoints);
  }
  EXPECT_LT(std::abs(together / kKeys), 4.0 / std::sqrt(double{kPoints} * kKeys));
  EXPECT_LT(std::sqrt(squares / kKeys), 2.0 / std::sqrt(double{kPoints}));
}

// Each number of a stratified path, single or part of a point, falls into a different interval of
// length 1/2^k for each of 2^k paths.
TEST(Random, StratifiedNumbersFillEveryIntervalOnce) {
  constexpr uint32_t kPaths = 64, kNumbers = 6;
  std::array<std::set<uint32_t>, kNumbers + 2> intervals;
  const auto of = [](float u) { return static_cast<uint32_t>(u * float{kPaths}); };
  for (uint32_t i = 0; i < kPaths; ++i) {
    Rng rng = Rng::stratified(5, i);
    for (uint32_t d = 0; d < kNumbers; ++d) intervals[d].insert(of(rng.next()));
    const Point2 point = rng.nextPoint();
    intervals[kNumbers].insert(of(point.x)), intervals[kNumbers + 1].insert(of(point.y));
  }
  for (const auto& found : intervals) EXPECT_EQ(found.size(), size_t{kPaths});
}

// Chi-square statistic of counts that should be equal; its mean is the number of cells minus one.
double chiSquare(const std::vector<int>& cells, double expected) {
  double sum = 0.0;
  for (const int n : cells) sum += (n - expected) * (n - expected) / expected;
  return sum;
}

TEST(Random, ConsecutiveNumbersFillTheSquareEvenly) {
  constexpr int kSide = 16, kDraws = 256 * 400;
  std::vector<int> cells(size_t{kSide} * kSide);
  for (int i = 0; i < kDraws; ++i) {
    Rng rng(streamKey(7, RandomStream::PixelSamples), uint64_t(i));
    const auto x = size_t(rng.next() * kSide), y = size_t(rng.next() * kSide);
    ++cells[y * kSide + x];
  }
  // 255 degrees of freedom have a standard deviation of 22.6; the tolerance is five of them.
  EXPECT_NEAR(chiSquare(cells, 400.0), 255.0, 113.0);
}

TEST(Random, NeighbouringIndicesAreUncorrelated) {
  constexpr int kDraws = 100000;
  double sum = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    Rng a(1, uint64_t(i)), b(1, uint64_t(i) + 1);
    sum += (double(a.next()) - 0.5) * (double(b.next()) - 0.5);
  }
  const double correlation = sum / kDraws * 12.0;
  EXPECT_NEAR(correlation, 0.0, 5.0 / std::sqrt(double(kDraws)));
}

// Every prefix is spread far more evenly than random points. A random count in a cell that expects
// 4 has variance 4, so their ratio is 1; the sequence stays far below that.
TEST(R2Sequence, EveryPrefixIsStratified) {
  for (const int side : {4, 8, 16, 32}) {
    const int count = side * side * 4;
    std::vector<int> cells(size_t(side * side));
    for (int i = 0; i < count; ++i) {
      const Point2 p = r2Sequence(uint64_t(i), 0.3, 0.8);
      ASSERT_TRUE(p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1);
      ++cells[size_t(p.y * float(side)) * size_t(side) + size_t(p.x * float(side))];
    }
    EXPECT_LT(chiSquare(cells, 4.0) / double(side * side), 0.35) << side;
    for (const int n : cells) EXPECT_GT(n, 0);
  }
}

TEST(R2Sequence, ShiftMovesAllPointsAlike) {
  for (uint64_t i = 0; i < 1000; ++i) {
    const Point2 a = r2Sequence(i, 0.0, 0.0), b = r2Sequence(i, 0.25, 0.5);
    const float dx = b.x - a.x + (b.x < a.x ? 1.0f : 0.0f),
                dy = b.y - a.y + (b.y < a.y ? 1.0f : 0.0f);
    EXPECT_NEAR(dx, 0.25f, 1e-6f);
    EXPECT_NEAR(dy, 0.5f, 1e-6f);
  }
}

TEST(R2Sequence, StaysFineBeyondManyPoints) {
  std::set<float> seen;
  for (uint64_t i = 0; i < 1000; ++i) seen.insert(r2Sequence((uint64_t{1} << 40) + i, 0, 0).x);
  EXPECT_EQ(seen.size(), 1000u);
}

}  // namespace
}  // namespace bnvpl
