#include "tools/estimate/emit_points.h"

#include <bit>
#include <cmath>

#include "core/random.h"

namespace bnvpl {

uint64_t positionHash(Vec3 p) {
  const uint64_t x = std::bit_cast<uint32_t>(p.x), y = std::bit_cast<uint32_t>(p.y);
  return mix64(x << 32 | y) + std::bit_cast<uint32_t>(p.z);
}

void EmitPoints::offer(size_t vpl, double weight, const SurfacePoint& hit) {
  if (perVpl_ == 0 || !(weight > 0.0)) return;
  // Relative to the VPL, so that the unit of length does not matter.
  const uint64_t key =
      random64(key_, vpl, 0) ^ positionHash((hit.position - position_[vpl]) / radius_[vpl]);
  for (size_t k = 0; k < perVpl_; ++k) {
    EmitPoint& winner = winners_[vpl * perVpl_ + k];
    const double u = (static_cast<double>(random64(key, k, 0) >> 12) + 0.5) * 0x1p-52;  // in (0, 1)
    // Rejects most hits without a logarithm, as -ln(u) >= 1 - u.
    if (1.0 - u > winner.key * weight) continue;
    const double drawn = -std::log(u) / weight;
    if (drawn < winner.key) winner = {drawn, hit.position, hit.ng};
  }
}

void EmitPoints::add(std::span<const EmitPoint> others) {
  for (size_t i = 0; i < winners_.size(); ++i) {
    if (others[i].key < winners_[i].key) winners_[i] = others[i];
  }
}

void EmitPoints::fill(VplTable& lit) const {
  if (perVpl_ == 0) return;
  lit.emitPoints = static_cast<uint32_t>(perVpl_);
  lit.emitPosition.clear();
  lit.emitNormal.clear();
  for (size_t i = 0; i < winners_.size(); ++i) {
    const bool won = std::isfinite(winners_[i].key);
    lit.emitPosition.push_back(won ? winners_[i].position : lit.position[i / perVpl_]);
    lit.emitNormal.push_back(won ? winners_[i].normal : lit.normal[i / perVpl_]);
  }
}

}  // namespace bnvpl
