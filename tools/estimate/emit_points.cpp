#include "tools/estimate/emit_points.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/parallel.h"
#include "core/random.h"

namespace bnvpl {

uint64_t positionHash(Vec3 p) {
  const uint64_t x = std::bit_cast<uint32_t>(p.x), y = std::bit_cast<uint32_t>(p.y);
  return mix64(x << 32 | y) + std::bit_cast<uint32_t>(p.z);
}

namespace {

// A uniform number in (0, 1).
double uniform(uint64_t random) { return (static_cast<double>(random >> 12) + 0.5) * 0x1p-52; }

// A hit that is rejected by bounds would not win in spite of rounding.
constexpr double kRounding = 1.0 + 0x1p-40;

}  // namespace

// The n keys times the weight are exponential random numbers. The smallest of n is an exponential
// number over n, in any place alike, and the others exceed it by exponential numbers. So one random
// number rejects most hits, and without a logarithm, as -ln(u) >= 1 - u.
void EmitPoints::offer(size_t vpl, double weight, const SurfacePoint& hit) {
  if (perVpl_ == 0 || !(weight > 0.0)) return;
  // Relative to the VPL, so that the unit of length does not matter.
  const uint64_t key =
      random64(key_, vpl, 0) ^ positionHash((hit.position - position_[vpl]) / radius_[vpl]);
  const auto n = static_cast<double>(perVpl_);
  const double u = uniform(random64(key, 0, 1)), limit = limit_[vpl] * weight * kRounding;
  if (1.0 - u > n * limit) return;
  const double smallest = -std::log(u) / n;
  if (smallest > limit) return;
  const auto place = static_cast<size_t>(uniform(random64(key, 1, 1)) * n);
  double largest = 0.0;
  for (size_t k = 0; k < perVpl_; ++k) {
    EmitPoint& winner = winners_[vpl * perVpl_ + k];
    const double exponential =
        k == place ? smallest : smallest - std::log(uniform(random64(key, k, 0)));
    const double drawn = exponential / weight;
    if (drawn < winner.key) winner = {drawn, hit.position, hit.ng};
    largest = std::max(largest, winner.key);
  }
  limit_[vpl] = largest;
}

void EmitPoints::add(std::span<const EmitPoint> others) {
  parallelFor(winners_.size(), 16384, [&](size_t i) {
    if (others[i].key < winners_[i].key) winners_[i] = others[i];
  });
}

void EmitPoints::fill(VplTable& lit) const {
  if (perVpl_ == 0) return;
  lit.emitPoints = static_cast<uint32_t>(perVpl_);
  lit.emitPosition.clear();
  lit.emitNormal.clear();
  lit.emitPosition.reserve(winners_.size());
  lit.emitNormal.reserve(winners_.size());
  for (size_t i = 0; i < winners_.size(); ++i) {
    const bool won = std::isfinite(winners_[i].key);
    lit.emitPosition.push_back(won ? winners_[i].position : lit.position[i / perVpl_]);
    lit.emitNormal.push_back(won ? winners_[i].normal : lit.normal[i / perVpl_]);
  }
}

}  // namespace bnvpl
