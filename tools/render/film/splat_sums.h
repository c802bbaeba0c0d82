// Exact sums of the photons' contributions to pixels. They depend neither on the order of photons
// nor on how these are divided among threads and shards.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tools/render/splat/splat.h"

namespace bnvpl {

// Kulisch accumulators: fixed-point numbers that span the range of floats, so that any number of
// finite floats are added without rounding. A number has kLimbs digits of 48 bits above 2^-149, the
// smallest float. A limb has room for many additions before its carry must be propagated.
class SplatSums {
 public:
  SplatSums() = default;  // has no pixels
  explicit SplatSums(size_t pixels) : values_(3 * pixels), limbs_(kLimbs * values_) {}

  void add(const Splat& splat) { add(splat.pixel, splat.radiance); }
  void add(size_t pixel, Vec3 radiance);  // only counts a splat that is not finite
  // Sum of channel `c` of a pixel.
  double sum(size_t pixel, size_t c) const;
  size_t pixels() const { return values_ / 3; }
  uint64_t nonFinite() const { return static_cast<uint64_t>(nonFinite_); }

  void addNonFinite(uint64_t count) { nonFinite_ += static_cast<int64_t>(count); }

  // Conversion to integers, which can be added to those of other photons, and back.
  static size_t integersFor(size_t pixels) { return pixels > 0 ? 3 * pixels * kLimbs + 1 : 0; }
  std::vector<int64_t> integers() const;
  void setIntegers(std::span<const int64_t> integers);  // integersFor(pixels()) of them

 private:
  static constexpr size_t kLimbs = 7;
  static constexpr int kBits = 48, kLowest = -149;
  using Limbs = std::array<int64_t, kLimbs>;

  Limbs carried(size_t value) const;  // all limbs but the highest are from 0 to 2^48 - 1
  void addTo(size_t value, float term);

  size_t values_ = 0;
  std::vector<int64_t> limbs_;  // limb by limb, each for all values; the lowest limb comes first
  int64_t nonFinite_ = 0;
};

}  // namespace bnvpl
