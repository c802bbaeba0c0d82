// Counter-based random numbers: the value depends on (key, index, dimension), never on who asks,
// when, or on which thread. Philox-like quality is not needed; SplitMix64's finaliser passes
// BigCrush.
#pragma once

#include <cstdint>

namespace bnvpl {

constexpr uint64_t mix64(uint64_t x) {  // SplitMix64 finaliser (Steele et al. 2014)
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

// A key for numbers of one purpose: streams never share numbers, even under one seed.
constexpr uint64_t streamKey(uint64_t seed, uint32_t stream) {
  return mix64(mix64(seed + 0x9e3779b97f4a7c15u) + stream);
}

constexpr uint64_t random64(uint64_t key, uint64_t index, uint32_t dimension) {
  return mix64(mix64(key + index * 0x9e3779b97f4a7c15u) + (dimension + 1) * 0xd1342543de82ef95u);
}
// Uniform in [0, 1): the top 24 bits, so that 1 is never reached.
constexpr float toUnitFloat(uint64_t bits) { return static_cast<float>(bits >> 40) * 0x1p-24f; }
// Nothing of a smaller probability can be drawn by such a number: 0, which is drawn this often,
// would take it every time, and what one over its probability multiplies would leave all bounds.
inline constexpr float kMinProbability = 0x1p-24f;

// Point `index` of the R2 sequence (Roberts 2018), shifted by `shift` in [0,1)^2: every prefix is
// well spread over the unit square. Double precision keeps it so beyond 2^24 points.
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

// Owen's scrambling of one coordinate in [0, 1) as 32-bit fixed point, by hashing: each bit is
// flipped or not as the bits above it and the key decide (Laine & Karras 2011; constants of
// Vegdahl 2021, "Building a better LK hash").
constexpr uint32_t reverseBits(uint32_t x) {
  x = x >> 16 | x << 16;
  x = (x & 0xff00ff00u) >> 8 | (x & 0x00ff00ffu) << 8;
  x = (x & 0xf0f0f0f0u) >> 4 | (x & 0x0f0f0f0fu) << 4;
  x = (x & 0xccccccccu) >> 2 | (x & 0x33333333u) << 2;
  return (x & 0xaaaaaaaau) >> 1 | (x & 0x55555555u) << 1;
}
// Of one whose first bit is the lowest.
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

// The second coordinate of Sobol's sequence for an index, its first bit the lowest: bit j is the
// sum, modulo 2, of those bits i of the index for which C(i, j) is odd, that is (Lucas 1878), which
// have all bits of j.
constexpr uint32_t sobolSecondReversed(uint32_t index) {
  index ^= index >> 1 & 0x55555555u;
  index ^= index >> 2 & 0x33333333u;
  index ^= index >> 4 & 0x0f0f0f0fu;
  index ^= index >> 8 & 0x00ff00ffu;
  return index ^ index >> 16;
}

// Point `index` of the first two dimensions of Sobol's sequence, scrambled by `key`: every 2^k
// points from a multiple of 2^k are spread over all boxes of area 2^-k, so that a mean over them
// has less noise than one over independent points (Owen 1997). Their order is scrambled too, so
// that sequences of two keys may go together, one for the pixel and one for the light: in one order
// both would always lie in corresponding halves, and no number of points would meet all pairs
// (Burley 2020).
constexpr Point2 owenSobol(uint32_t index, uint64_t key) {
  const uint64_t bits = mix64(key);
  index = owenScramble(index, static_cast<uint32_t>(mix64(bits)));
  const uint32_t x = reverseBits(owenScrambleReversed(index, static_cast<uint32_t>(bits)));
  const uint32_t y = reverseBits(
      owenScrambleReversed(sobolSecondReversed(index), static_cast<uint32_t>(bits >> 32)));
  return {toUnitFloat(uint64_t{x} << 32), toUnitFloat(uint64_t{y} << 32)};
}

// The numbers of one path, photon or pixel sample, in order of use: single ones, and points of the
// unit square.
class Rng {
 public:
  constexpr Rng(uint64_t key, uint64_t index) : state_(mix64(key + index * 0x9e3779b97f4a7c15u)) {}
  // Those of one of many paths that begin alike, such as a pixel's: the first of them are spread
  // evenly over all with that key, for each is a point of a sequence of its own.
  static constexpr Rng spread(uint64_t key, uint32_t index) {
    Rng rng(key, index);
    rng.key_ = key, rng.index_ = index, rng.spread_ = kSpread;
    return rng;
  }
  constexpr float next() { return spread_ > 0 ? nextOfSequence().x : nextAlone(); }
  constexpr Point2 nextPoint() {
    if (spread_ > 0) return nextOfSequence();
    const float x = nextAlone();
    return {x, nextAlone()};
  }

 private:
  static constexpr uint32_t kSpread = 8;  // far down a path all numbers matter together

  constexpr float nextAlone() {
    ++dimension_;
    return toUnitFloat(mix64(state_ + dimension_ * 0xd1342543de82ef95u));
  }
  constexpr Point2 nextOfSequence() {
    return owenSobol(index_, key_ + spread_-- * 0xd1342543de82ef95u);
  }

  uint64_t state_;
  uint64_t dimension_ = 0;
  uint64_t key_ = 0;
  uint32_t index_ = 0;
  uint32_t spread_ = 0;  // points of sequences still to come
};

}  // namespace bnvpl
