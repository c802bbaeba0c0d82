#include "spatial/morton_order.h"

#include <tbb/parallel_sort.h>

#include "core/parallel.h"

namespace bnvpl {
namespace {

// Moves bit b of a 10-bit number to bit 3 b.
uint32_t spreadBits(uint32_t v) {
  v = (v | v << 16) & 0x030000ffu;
  v = (v | v << 8) & 0x0300f00fu;
  v = (v | v << 4) & 0x030c30c3u;
  return (v | v << 2) & 0x09249249u;
}

// Coordinates that floats cannot scale are in cell 0.
uint32_t cellOf(float scaled) {
  return scaled >= 0.0f && scaled < 1024.0f ? static_cast<uint32_t>(scaled) : 0;
}

}  // namespace

std::vector<uint32_t> mortonOrder(std::span<const Vec3> points) {
  Bounds bounds;
  for (const Vec3 p : points) bounds.extend(p);
  const float extent = maxComponent(bounds.extent());
  const float cellsPerUnit = extent > 0.0f ? 1023.0f / extent : 0.0f;
  std::vector<uint64_t> keys(points.size());  // Morton code and index, so that all keys differ
  parallelFor(points.size(), 4096, [&](size_t i) {
    const Vec3 cell = (points[i] - bounds.lower) * cellsPerUnit;
    const uint32_t code = spreadBits(cellOf(cell.x)) << 2 | spreadBits(cellOf(cell.y)) << 1 |
                          spreadBits(cellOf(cell.z));
    keys[i] = uint64_t{code} << 32 | i;
  });
  tbb::parallel_sort(keys.begin(), keys.end());
  std::vector<uint32_t> order(points.size());
  parallelFor(points.size(), 4096, [&](size_t i) { order[i] = static_cast<uint32_t>(keys[i]); });
  return order;
}

}  // namespace bnvpl
