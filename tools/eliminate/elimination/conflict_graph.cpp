#include "tools/eliminate/elimination/conflict_graph.h"

#include <emmintrin.h>
#include <tbb/parallel_invoke.h>

#include <bit>
#include <limits>

#include "core/parallel.h"
#include "spatial/compatible_surface.h"

namespace bnvpl {
namespace {

// The weight of a node has at most size() terms of at most 2^bits each, so it fits in 63 bits.
float fixedPointScale(size_t size) {
  const int bits = std::min(40, 63 - static_cast<int>(std::bit_width(size)));
  return std::ldexp(1.0f, bits);
}

template <typename T>
void keepOnly(std::vector<T>& values, const std::vector<uint8_t>& keep, size_t padding = 0) {
  size_t kept = 0;
  for (size_t i = 0; i < keep.size(); ++i) {
    if (keep[i]) values[kept++] = values[i];
  }
  values.resize(kept + padding);
  values.shrink_to_fit();
}

}  // namespace

ConflictGraph::ConflictGraph(std::vector<Vec3> position, std::vector<Vec3> normal,
                             std::vector<float> radius, std::vector<uint32_t> row,
                             const PairWeight& rule, const ProgressFn& progress)
    : cells_(makeCellLists(position, radius)),
      radius_(std::move(radius)),
      normal_(std::move(normal)),
      row_(std::move(row)),
      rule_(rule),
      scale_(fixedPointScale(position.size())) {
  const std::vector<uint32_t>& order = cells_.order;
  const size_t padded = order.size() + kLanes;
  x_.resize(padded), y_.resize(padded), z_.resize(padded);
  parallelFor(order.size(), 4096, [&](size_t k) {
    const Vec3 p = position[order[k]];
    x_[k] = p.x, y_[k] = p.y, z_[k] = p.z;
  });
  position = {};
  radius_ = inOrder<float>(radius_, order);
  radius_.resize(padded);
  normal_ = inOrder<Vec3>(normal_, order);
  row_ = inOrder<uint32_t>(row_, order);
  cells_.order = {};
  weight_.resize(size());
  const auto phase = progress.beginPhase("conflict weights", size());
  parallelRanges(size(), 256, [&](size_t begin, size_t end) {
    for (auto i = static_cast<uint32_t>(begin); i < end; ++i) {
      uint64_t sum = 0;
      visitNeighbours(i, [&](uint32_t j, float d2) { sum += pairWeight(i, j, d2); });
      weight_[i] = sum;
    }
    if (progress) progress(end - begin);
  });
}

inline bool ConflictGraph::compatible(uint32_t i, uint32_t j) const {
  return compatibleSurfaces({x_[i], y_[i], z_[i]}, normal_[i], {x_[j], y_[j], z_[j]}, normal_[j],
                            kPlaneFactor * (radius_[i] + radius_[j]));
}

// Finds the nodes of a range that are nearer to i than the sum of both radii. The range has at most
// kAtOnce nodes; removed ones are never found. Four are tested at a time, since these tests take
// much of the stage's time.
size_t ConflictGraph::nearIn(uint32_t i, CellLists::Range range, Near* found) const {
  const __m128 x = _mm_set1_ps(x_[i]), y = _mm_set1_ps(y_[i]), z = _mm_set1_ps(z_[i]);
  const __m128 radius = _mm_set1_ps(radius_[i]);
  size_t count = 0;
  for (uint32_t j = range.begin; j < range.end; j += kLanes) {
    const __m128 dx = _mm_sub_ps(_mm_loadu_ps(&x_[j]), x);
    const __m128 dy = _mm_sub_ps(_mm_loadu_ps(&y_[j]), y);
    const __m128 dz = _mm_sub_ps(_mm_loadu_ps(&z_[j]), z);
    const __m128 d2 =
        _mm_add_ps(_mm_add_ps(_mm_mul_ps(dx, dx), _mm_mul_ps(dy, dy)), _mm_mul_ps(dz, dz));
    const __m128 maxDistance = _mm_add_ps(_mm_loadu_ps(&radius_[j]), radius);
    auto mask = static_cast<unsigned>(
        _mm_movemask_ps(_mm_cmplt_ps(d2, _mm_mul_ps(maxDistance, maxDistance))));
    if (range.end - j < kLanes) mask &= (1u << (range.end - j)) - 1u;
    alignas(16) float distances[kLanes];
    _mm_store_ps(distances, d2);
    for (; mask != 0; mask &= mask - 1) {
      const auto lane = static_cast<uint32_t>(std::countr_zero(mask));
      found[count++] = {distances[lane], j + lane};
    }
  }
  return count;
}

// Calls visit(j, distanceSquared) for each neighbour j of i.
template <typename Visit>
void ConflictGraph::visitNeighbours(uint32_t i, const Visit& visit) const {
  Near near[kAtOnce];
  for (CellLists::Range range : cells_.near(i)) {
    for (; range.begin < range.end; range.begin += kAtOnce) {
      const uint32_t end = std::min(range.end, range.begin + kAtOnce);
      const size_t count = nearIn(i, {range.begin, end}, near);
      for (size_t n = 0; n < count; ++n) {
        const uint32_t j = near[n].index;
        if (j != i && compatible(i, j)) visit(j, near[n].distanceSquared);
      }
    }
  }
}

uint32_t ConflictGraph::heavierNeighbour(uint32_t i) const {
  const uint64_t own = weight_[i];
  const uint64_t* const weight = weight_.data();
  for (const CellLists::Range range : cells_.near(i)) {
    for (uint32_t j = range.begin; j < range.end; ++j) {
      if (weight[j] < own || !outweighs(j, i)) continue;  // also skips removed nodes, and i itself
      const float x = x_[j] - x_[i], y = y_[j] - y_[i], z = z_[j] - z_[i];
      const float maxDistance = radius_[i] + radius_[j];
      if (x * x + y * y + z * z < maxDistance * maxDistance && compatible(i, j)) return j;
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
  parallelFor(keep.size(), 4096, [&](size_t i) { keep[i] = !removed(static_cast<uint32_t>(i)); });
  tbb::parallel_invoke([&] { cells_.compact(keep); }, [&] { keepOnly(x_, keep, kLanes); },
                       [&] { keepOnly(y_, keep, kLanes); }, [&] { keepOnly(z_, keep, kLanes); },
                       [&] { keepOnly(radius_, keep, kLanes); }, [&] { keepOnly(normal_, keep); },
                       [&] { keepOnly(row_, keep); }, [&] { keepOnly(weight_, keep); });
}

}  // namespace bnvpl
