// Sums of what photons bring to pixels: exact, so that neither their order nor who adds them up
// matters.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tools/render/splat/splat.h"

namespace bnvpl {

// Any number of finite floats add up without rounding in a fixed-point number that spans all of
// them (Kulisch's accumulator): kLimbs digits of 48 bits above 2^-149, the smallest float. A limb
// has room for many additions before it hands a carry on.
class SplatSums {
 public:
  SplatSums() = default;  // of no film
  explicit SplatSums(size_t pixels) : values_(3 * pixels), limbs_(kLimbs * values_) {}

  void add(const Splat& splat);  // one that is not finite is counted
  // Of channel `c` of a pixel, rounded once.
  double sum(size_t pixel, size_t c) const;
  size_t pixels() const { return values_ / 3; }
  uint64_t nonFinite() const { return static_cast<uint64_t>(nonFinite_); }

  void addNonFinite(uint64_t count) { nonFinite_ += static_cast<int64_t>(count); }

  // As integers that add up with those of other photons, and back.
  static size_t integersFor(size_t pixels) { return pixels > 0 ? 3 * pixels * kLimbs + 1 : 0; }
  std::vector<int64_t> integers() const;
  void setIntegers(std::span<const int64_t> integers);  // as many

 private:
  static constexpr size_t kLimbs = 7;
  static constexpr int kBits = 48, kLowest = -149;
  using Limbs = std::array<int64_t, kLimbs>;

  Limbs carried(size_t value) const;  // all but the highest from 0 to 2^48 - 1
  void addTo(size_t value, float term);

  size_t values_ = 0;
  std::vector<int64_t> limbs_;  // the lowest of all values, then the next
  int64_t nonFinite_ = 0;
};

}  // namespace bnvpl
