#include "tools/render/film/splat_sums.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace bnvpl {
namespace {

Splat splatOf(uint32_t pixel, float value) { return {pixel, Vec3{value}}; }

TEST(SplatSums, AreExactWhateverTheirSize) {
  SplatSums sums(2);
  for (const float value : {0x1p-149f, 3.0f, 0x1.fffffep127f, -0x1.8p100f, 0x1p-126f})
    sums.add(splatOf(1, value));
  for (const float value : {-0x1.fffffep127f, 0x1.8p100f, -3.0f, -0x1p-126f})
    sums.add(splatOf(1, value));
  for (size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(sums.sum(1, c), 0x1p-149);  // all but the smallest have cancelled
    EXPECT_EQ(sums.sum(0, c), 0.0);
  }
}

TEST(SplatSums, MayBeNegative) {
  for (const float value : {-1.0f, -3.0f, -0x1.fffffep127f, -0x1p-149f, -1e-3f, -1e10f}) {
    SplatSums sums(1);
    sums.add(splatOf(0, value));
    EXPECT_EQ(sums.sum(0, 0), double{value});
    sums.add(splatOf(0, 1.0f));
    EXPECT_EQ(sums.sum(0, 1), double{value} + 1.0) << value;
  }
}

TEST(SplatSums, HandTheirCarriesOn) {
  SplatSums sums(1);
  for (int i = 0; i < 200000; ++i) sums.add(splatOf(0, 0x1.fffffep20f));
  EXPECT_EQ(sums.sum(0, 0), 200000.0 * 0x1.fffffep20);
}

TEST(SplatSums, CountWhatIsNotFinite) {
  SplatSums sums(1);
  sums.add(splatOf(0, NAN));
  sums.add(splatOf(0, INFINITY));
  sums.add(splatOf(0, 2.0f));
  EXPECT_EQ(sums.nonFinite(), 2u);
  EXPECT_EQ(sums.sum(0, 2), 2.0);
}

// The splats are added in another order, and in two parts whose integers are summed.
TEST(SplatSums, DoNotDependOnOrderOrParts) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> exponent(-40.0f, 40.0f);
  std::vector<Splat> splats(20000);
  for (Splat& s : splats)
    s = {static_cast<uint32_t>(random() % 3), {std::exp(exponent(random)), 1.0f, 0x1p-140f}};
  const auto integersOf = [&](size_t begin, size_t end) {
    SplatSums sums(3);
    for (size_t i = begin; i < end; ++i) sums.add(splats[i]);
    return sums.integers();
  };
  const std::vector<int64_t> whole = integersOf(0, splats.size());
  ASSERT_EQ(whole.size(), SplatSums::integersFor(3));
  std::shuffle(splats.begin(), splats.end(), random);
  EXPECT_EQ(integersOf(0, splats.size()), whole);
  std::vector<int64_t> parts = integersOf(0, 7000);
  const std::vector<int64_t> rest = integersOf(7000, splats.size());
  for (size_t i = 0; i < parts.size(); ++i) parts[i] += rest[i];
  SplatSums added(3);
  added.setIntegers(parts);
  EXPECT_EQ(added.integers(), whole);
}

}  // namespace
}  // namespace bnvpl
