#include "tools/eliminate/conflict_graph.h"

#include <bit>
#include <limits>

#include "core/compatibility.h"
#include "core/parallel.h"

namespace bnvpl {
namespace {

// A node's sum has at most size() terms of at most 2^bits: 63 bits hold it.
float fixedPointScale(size_t size) {
  const int bits = std::min(40, 63 - static_cast<int>(std::bit_width(size)));
  return std::ldexp(1.0f, bits);
}

template <typename T>
void reorder(std::vector<T>& values, const std::vector<uint32_t>& order) {
  std::vector<T> out(order.size());
  parallelFor(order.size(), 4096, [&](size_t i) { out[i] = values[order[i]]; });
  values = std::move(out);
}

template <typename T>
void keepOnly(std::vector<T>& values, const std::vector<uint8_t>& keep) {
  size_t kept = 0;
  for (size_t i = 0; i < keep.size(); ++i) {
    if (keep[i]) values[kept++] = values[i];
  }
  values.resize(kept);
  values.shrink_to_fit();
}

}  // namespace

ConflictGraph::ConflictGraph(std::vector<Vec3> position, std::vector<Vec3> normal,
                             std::vector<float> radius, std::vector<uint32_t> row,
                             const PairWeight& rule)
    : cells_(makeCellLists(position, radius)),
      radius_(std::move(radius)),
      normal_(std::move(normal)),
      row_(std::move(row)),
      rule_(rule),
      scale_(fixedPointScale(position.size())) {
  const std::vector<uint32_t>& order = cells_.order;
  x_.resize(order.size()), y_.resize(order.size()), z_.resize(order.size());
  parallelFor(order.size(), 4096, [&](size_t k) {
    const Vec3 p = position[order[k]];
    x_[k] = p.x, y_[k] = p.y, z_[k] = p.z;
  });
  position = {};
  reorder(radius_, order);
  reorder(normal_, order);
  reorder(row_, order);
  cells_.order = {};
  weight_.resize(x_.size());
  parallelFor(size(), 256, [&](size_t k) {
    const auto i = static_cast<uint32_t>(k);
    uint64_t sum = 0;
    visitNeighbours(i, [&](uint32_t j, float d2) { sum += pairWeight(i, j, d2); });
    weight_[i] = sum;
  });
}

bool ConflictGraph::onOneSheet(uint32_t i, uint32_t j) const {
  return sameSheet({x_[i], y_[i], z_[i]}, normal_[i], {x_[j], y_[j], z_[j]}, normal_[j],
                   kPlaneFactor * (radius_[i] + radius_[j]));
}

// Calls visit(j, distanceSquared). First what is near enough, without a branch: a scan meets about
// three nodes for each that is.
template <typename Visit>
void ConflictGraph::visitNeighbours(uint32_t i, const Visit& visit) const {
  struct Near {
    float distanceSquared;
    uint32_t index;
  };
  constexpr uint32_t kAtOnce = 256;
  Near near[kAtOnce];
  const float radius = radius_[i];
  for (const CellLists::Range range : cells_.near(i)) {
    for (uint32_t begin = range.begin; begin < range.end; begin += kAtOnce) {
      const uint32_t end = std::min(range.end, begin + kAtOnce);
      size_t found = 0;
      for (uint32_t j = begin; j < end; ++j) {
        const float d2 = distanceSquared(i, j), reach = radius + radius_[j];
        near[found] = {d2, j};
        found += d2 < reach * reach;  // never for a removed j
      }
      for (size_t n = 0; n < found; ++n) {
        const uint32_t j = near[n].index;
        if (j != i && onOneSheet(i, j)) visit(j, near[n].distanceSquared);
      }
    }
  }
}

uint32_t ConflictGraph::heavierNeighbour(uint32_t i) const {
  const uint64_t own = weight_[i];
  for (const CellLists::Range range : cells_.near(i)) {
    for (uint32_t j = range.begin; j < range.end; ++j) {
      if (weight_[j] < own || !outweighs(j, i)) continue;  // so are the removed, and i itself
      const float reach = radius_[i] + radius_[j];
      if (distanceSquared(i, j) < reach * reach && onOneSheet(i, j)) return j;
    }
  }
  return kNone;
}

void ConflictGraph::release(uint32_t i) {
  visitNeighbours(i, [&](uint32_t j, float d2) {
    std::atomic_ref(weight_[j]).fetch_sub(pairWeight(i, j, d2), std::memory_order_relaxed);
  });
}

void ConflictGraph::markRemoved(uint32_t i) {
  radius_[i] = std::numeric_limits<float>::quiet_NaN();
  weight_[i] = 0;
}

void ConflictGraph::compact() {
  std::vector<uint8_t> keep(size());
  for (uint32_t i = 0; i < size(); ++i) keep[i] = !removed(i);
  cells_.compact(keep);
  keepOnly(x_, keep);
  keepOnly(y_, keep);
  keepOnly(z_, keep);
  keepOnly(radius_, keep);
  keepOnly(normal_, keep);
  keepOnly(row_, keep);
  keepOnly(weight_, keep);
}

}  // namespace bnvpl
