#include "tools/render/film/splat_sums.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace bnvpl {

namespace {

// Value of a limb from which carries are propagated.
constexpr int64_t kFull = int64_t{1} << 62;

}  // namespace

void SplatSums::add(size_t pixel, Vec3 radiance) {
  if (!isFinite(radiance)) {
    ++nonFinite_;
    return;
  }
  for (int c = 0; c < 3; ++c) addTo(3 * pixel + size_t(c), radiance[c]);
}

void SplatSums::addTo(size_t value, float term) {
  if (term == 0.0f) return;
  int exponent = 0;
  const auto digits = static_cast<int64_t>(std::ldexp(std::frexp(term, &exponent), 24));
  // term = digits * 2^(exponent - 24); the last digits of denormal floats are zero.
  const int above = exponent - 24 - kLowest;
  const int place = std::max(0, above);
  const auto shifted = static_cast<__int128>(above < 0 ? digits >> -above : digits)
                       << (place % kBits);
  const size_t limb = static_cast<size_t>(place / kBits);
  constexpr auto kMask = (int64_t{1} << kBits) - 1;
  int64_t& low = limbs_[limb * values_ + value];
  low += static_cast<int64_t>(shifted) & kMask;
  limbs_[(limb + 1) * values_ + value] += static_cast<int64_t>(shifted >> kBits);
  if (low < kFull) return;
  const Limbs limbs = carried(value);
  for (size_t k = 0; k < kLimbs; ++k) limbs_[k * values_ + value] = limbs[k];
}

SplatSums::Limbs SplatSums::carried(size_t value) const {
  Limbs limbs;
  int64_t carry = 0;
  for (size_t k = 0; k < kLimbs; ++k) {
    const int64_t sum = limbs_[k * values_ + value] + carry;
    carry = k + 1 < kLimbs ? sum >> kBits : 0;
    limbs[k] = sum - carry * (int64_t{1} << kBits);
  }
  return limbs;
}

double SplatSums::sum(size_t pixel, size_t c) const {
  const Limbs limbs = carried(3 * pixel + c);
  double sum = 0.0;
  // Only the highest limb of a negative sum is negative; the lower ones nearly cancel it, so that a
  // sum from below would round it away.
  const bool fromAbove = limbs.back() < 0;
  for (size_t i = 0; i < kLimbs; ++i) {
    const size_t k = fromAbove ? kLimbs - 1 - i : i;
    sum += std::ldexp(static_cast<double>(limbs[k]), kLowest + kBits * static_cast<int>(k));
  }
  return sum;
}

std::vector<int64_t> SplatSums::integers() const {
  if (values_ == 0) return {};
  std::vector<int64_t> all(limbs_.size() + 1);
  parallelFor(values_, 4096, [&](size_t v) {
    const Limbs limbs = carried(v);
    for (size_t k = 0; k < kLimbs; ++k) all[k * values_ + v] = limbs[k];
  });
  all.back() = nonFinite_;
  return all;
}

void SplatSums::setIntegers(std::span<const int64_t> integers) {
  if (values_ == 0) return;
  std::copy_n(integers.begin(), limbs_.size(), limbs_.begin());
  nonFinite_ = integers.back();
}

}  // namespace bnvpl
