// The statistical test itself: Student's t, and images whose expectations are known.
#include "tests/support/z_test.h"

#include "core/sampling.h"
#include "tests/support/flat_image.h"
#include "tests/support/student_t.h"

namespace bnvpl::test {
namespace {

TEST(StudentT, AsInTables) {
  EXPECT_NEAR(studentTwoSided(12.7062047, 1), 0.05, 1e-8);
  EXPECT_NEAR(studentTwoSided(2.2281389, 10), 0.05, 1e-8);
  EXPECT_NEAR(studentTwoSided(-3.7676, 23), 0.001, 1e-6);
  EXPECT_EQ(studentTwoSided(0.0, 5), 1.0);
  EXPECT_NEAR(studentTwoSided(1e4, 3) / 2.2053e-12, 1.0, 1e-3);  // 2 Gamma(2) 3^1.5 / ...: a power
  EXPECT_NEAR(sidak(0.05, 2), 0.0975, 1e-12);
}

// Independent normal noise about `mean`, with `deviation`.
Image noise(uint64_t seed, double mean, double deviation) {
  Image image = flatImage(20, 12, 0, 0, 0);
  for (size_t c = 0; c < 3; ++c) {
    for (size_t i = 0; i < image.pixelCount(); ++i) {
      Rng rng(mix64(seed), 3 * i + c);
      const float u = rng.next(), v = rng.next();  // Box and Muller
      const double normal = std::sqrt(-2.0 * std::log1p(-double{u})) * std::cos(6.2831853 * v);
      image.channels[c].data[i] = static_cast<float>(mean + deviation * normal);
    }
  }
  return image;
}

// If both expectations are equal, p is uniform in 0..1 up to the correlation of nested blocks.
TEST(ZTest, EqualExpectationsAreSeldomTakenForDifferent) {
  int below = 0;
  for (uint64_t round = 0; round < 60; ++round) {
    const auto a = [&](uint64_t seed) { return noise(1000 * round + seed, 1.0, 0.1); };
    const auto b = [&](uint64_t seed) { return noise(1000 * round + seed + 500, 1.0, 0.3); };
    below += zTest(a, b, {.seeds = 8}).p < 0.1;
  }
  EXPECT_LE(below, 14);  // expected: 6; 3.4 standard deviations
}

TEST(ZTest, FindsOnePixelThatIsWrong) {
  const auto a = [&](uint64_t seed) { return noise(seed, 1.0, 0.1); };
  const auto b = [&](uint64_t seed) {
    Image image = noise(seed + 500, 1.0, 0.1);
    image.channels[1].data[5 * 20 + 7] += 0.4f;
    return image;
  };
  const ZResult r = zTest(a, b);
  EXPECT_EQ(std::tuple(r.block, r.x, r.y, r.channel), std::tuple(1, 7, 5, 'G'));
  EXPECT_LT(r.p, 1e-4);
  EXPECT_NEAR(r.meanB - r.meanA, 0.4, 0.15);
}

TEST(ZTest, FindsAnErrorThatIsSmallButEverywhere) {
  const auto a = [&](uint64_t seed) { return noise(seed, 1.0, 0.1); };
  const auto b = [&](uint64_t seed) { return noise(seed + 500, 1.02, 0.1); };
  const ZResult r = zTest(a, b);
  EXPECT_GE(r.block, 8);
  EXPECT_LT(r.p, 1e-8);
}

TEST(ZTest, WithoutNoiseOnlyRoundingIsForgiven) {
  const auto flat = [](float v) { return [=](uint64_t) { return flatImage(4, 4, v, v, v); }; };
  EXPECT_TRUE(sameExpectation(flat(1.0f), flat(std::nextafter(1.0f, 2.0f))));
  EXPECT_FALSE(sameExpectation(flat(0.0f), flat(0.0f)));  // black images show nothing
  EXPECT_FALSE(sameExpectation(flat(1.0f), flat(1.0001f)));
  EXPECT_FALSE(sameExpectation(flat(1.0f), flat(NAN)));
}

}  // namespace
}  // namespace bnvpl::test
