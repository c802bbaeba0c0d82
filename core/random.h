// Counter-based random numbers: a value depends on (key, index, dimension) only, not on threads or
// the order of calls. The mixing function is SplitMix64's finaliser, which passes BigCrush.
#pragma once

#include <cstdint>

namespace bnvpl {

constexpr uint64_t mix64(uint64_t x) {  // SplitMix64 finaliser (Steele et al. 2014)
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

// A key for one purpose. Streams of the same seed have different numbers.
constexpr uint64_t streamKey(uint64_t seed, uint32_t stream) {
  return mix64(mix64(seed + 0x9e3779b97f4a7c15u) + stream);
}

constexpr uint64_t random64(uint64_t key, uint64_t index, uint32_t dimension) {
  return mix64(mix64(key + index * 0x9e3779b97f4a7c15u) + (dimension + 1) * 0xd1342543de82ef95u);
}
// Uniform in [0, 1): the top 24 bits, so that 1 is never reached.
constexpr float toUnitFloat(uint64_t bits) { return static_cast<float>(bits >> 40) * 0x1p-24f; }
// The same with 53 bits, for choices that use one number several times.
constexpr double toUnitDouble(uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }
// Min probability of an event that is sampled by a number of 24 bits. The number 0 alone has this
// probability, so that less likely events would be sampled too often, with weights out of bounds.
inline constexpr float kMinProbability = 0x1p-24f;

// Point `index` of the R2 sequence (Roberts 2018), shifted by a vector in [0,1)^2. Every prefix is
// well distributed over the unit square; 64-bit fixed point keeps it so beyond 2^24 points.
struct Point2 {
  float x, y;
};
constexpr Point2 r2Sequence(uint64_t index, double shiftX, double shiftY) {
  // The plastic number p solves p^3 = p + 1; the steps are 1/p and 1/p^2, in 0.64 fixed point,
  // whose wrap-around is the fractional part.
  const uint64_t x = index * 0xc13fa9a902a6328fu + static_cast<uint64_t>(shiftX * 0x1p63) * 2;
  const uint64_t y = index * 0x91e10da5c79e7b1du + static_cast<uint64_t>(shiftY * 0x1p63) * 2;
  return {toUnitFloat(x), toUnitFloat(y)};
}

// Point `index` of 32 in the unit square: y is the middle of a stratum each, and x advances by the
// golden ratio.
inline constexpr uint32_t kGoldenPoints = 32;
constexpr Point2 goldenPoint(uint32_t index) {
  return {toUnitFloat(uint64_t{index} * 0x9e3779b97f4a7c15u),
          (static_cast<float>(index) + 0.5f) / static_cast<float>(kGoldenPoints)};
}

constexpr uint32_t reverseBits(uint32_t x) {
  x = x >> 16 | x << 16;
  x = (x & 0xff00ff00u) >> 8 | (x & 0x00ff00ffu) << 8;
  x = (x & 0xf0f0f0f0u) >> 4 | (x & 0x0f0f0f0fu) << 4;
  x = (x & 0xccccccccu) >> 2 | (x & 0x33333333u) << 2;
  return (x & 0xaaaaaaaau) >> 1 | (x & 0x55555555u) << 1;
}
// Hash-based Owen scrambling of one coordinate in [0, 1), in 32-bit fixed point: the key and the
// bits above it decide whether a bit is flipped (Laine & Karras 2011; constants of Vegdahl 2021,
// "Building a better LK hash").
// Here the bits are reversed: the most significant bit is the lowest.
constexpr uint32_t owenScrambleReversed(uint32_t x, uint32_t key) {
  x ^= x * 0x3d20adeau;
  x += key;
  x *= (key >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}
constexpr uint32_t owenScramble(uint32_t x, uint32_t key) {
  return reverseBits(owenScrambleReversed(reverseBits(x), key));
}

// The second coordinate of the Sobol sequence, with reversed bits. Bit j is the sum modulo 2 of
// those bits i of the index for which C(i, j) is odd, that is, for which i has all bits of j (Lucas
// 1878).
constexpr uint32_t sobolSecondReversed(uint32_t index) {
  index ^= index >> 1 & 0x55555555u;
  index ^= index >> 2 & 0x33333333u;
  index ^= index >> 4 & 0x0f0f0f0fu;
  index ^= index >> 8 & 0x00ff00ffu;
  return index ^ index >> 16;
}

// Point `index` of the first two dimensions of the Sobol sequence, Owen-scrambled by `key`. Any 2^k
// points from a multiple of 2^k hit each elementary box of area 2^-k once, so that their mean has
// less variance than that of independent points (Owen 1997). The order of the points is scrambled,
// too (Burley 2020): without it, two sequences, such as one for the pixel and one for the light,
// would be correlated, and some pairs of strata would never occur.
constexpr Point2 owenSobol(uint32_t index, uint64_t key) {
  const uint64_t bits = mix64(key);
  index = owenScramble(index, static_cast<uint32_t>(mix64(bits)));
  const uint32_t x = reverseBits(owenScrambleReversed(index, static_cast<uint32_t>(bits)));
  const uint32_t y = reverseBits(
      owenScrambleReversed(sobolSecondReversed(index), static_cast<uint32_t>(bits >> 32)));
  return {toUnitFloat(uint64_t{x} << 32), toUnitFloat(uint64_t{y} << 32)};
}

// The random numbers of one path, photon or pixel sample in order of use: single ones, and points
// of the unit square.
class Rng {
 public:
  constexpr Rng(uint64_t key, uint64_t index) : state_(mix64(key + index * 0x9e3779b97f4a7c15u)) {}
  // Random numbers of one path among many that share their first vertex, such as those of a pixel.
  // The first kStratifiedPoints points are stratified over all paths with this key; next() takes
  // the first number of a point.
  static constexpr Rng stratified(uint64_t key, uint32_t index) {
    Rng rng(key, index);
    rng.key_ = key, rng.index_ = index, rng.pointsLeft_ = kStratifiedPoints;
    return rng;
  }
  // Numbers independent of those that are still to come. Forks at the same place are equal.
  constexpr Rng fork() const { return {state_, dimension_}; }
  constexpr float next() { return pointsLeft_ > 0 ? nextOfSequence().x : nextAlone(); }
  constexpr Point2 nextPoint() {
    if (pointsLeft_ > 0) return nextOfSequence();
    const float x = nextAlone();
    return {x, nextAlone()};
  }

 private:
  // Later points gain little from stratification.
  static constexpr uint32_t kStratifiedPoints = 8;

  constexpr float nextAlone() {
    ++dimension_;
    return toUnitFloat(mix64(state_ + dimension_ * 0xd1342543de82ef95u));
  }
  constexpr Point2 nextOfSequence() {
    return owenSobol(index_, key_ + pointsLeft_-- * 0xd1342543de82ef95u);
  }

  uint64_t state_;
  uint64_t dimension_ = 0;
  uint64_t key_ = 0;
  uint32_t index_ = 0;
  uint32_t pointsLeft_ = 0;  // number of stratified points left
};

}  // namespace bnvpl
