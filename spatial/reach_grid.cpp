#include "spatial/reach_grid.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>

#include "core/random.h"

namespace bnvpl {

namespace {

// A cell's three coordinates, mixed. Two cells of one key would share a list: harmless, since every
// entry's distance is tested, but an entry must then not be listed twice; so keys are exact: 21
// bits an axis.
constexpr int64_t kAxisBits = 21;
constexpr int64_t kAxisMask = (int64_t{1} << kAxisBits) - 1;

int64_t cellOf(float offset, float cellSize) {
  const float c = std::floor(offset / cellSize);
  return static_cast<int64_t>(std::clamp(c, -1.0e6f, 1.0e6f));
}

uint64_t packCell(int64_t x, int64_t y, int64_t z) {
  const auto bits = [](int64_t v) {
    return static_cast<uint64_t>((v + (int64_t{1} << (kAxisBits - 1))) & kAxisMask);
  };
  return mix64(bits(x) | bits(y) << kAxisBits | bits(z) << (2 * kAxisBits));
}

}  // namespace

uint64_t ReachGrid::cellKey(Vec3 at, float cellSize) const {
  const Vec3 o = at - origin_;
  return packCell(cellOf(o.x, cellSize), cellOf(o.y, cellSize), cellOf(o.z, cellSize));
}

ReachGrid::ReachGrid(std::span<const Vec3> points, std::span<const float> radii)
    : points_(points), radii_(radii) {
  if (points.empty()) return;
  origin_ = points[0];
  // Levels by powers of two of the radius; the cell is two radii wide at the top of a level.
  std::map<int, std::vector<uint32_t>> byLevel;
  for (size_t i = 0; i < points.size(); ++i) {
    byLevel[std::ilogb(radii[i])].push_back(static_cast<uint32_t>(i));
  }
  for (const auto& [exponent, members] : byLevel) {
    Level level;
    level.cellSize = std::ldexp(4.0f, exponent);
    buildLevel(level, members);
    levels_.push_back(std::move(level));
  }
}

void ReachGrid::buildLevel(Level& level, const std::vector<uint32_t>& members) {
  std::vector<std::pair<uint64_t, uint32_t>> listed;  // cell, disk
  for (const uint32_t i : members) {
    const Vec3 low = points_[i] - origin_ - Vec3{radii_[i]},
               high = points_[i] - origin_ + Vec3{radii_[i]};
    const float c = level.cellSize;
    for (int64_t z = cellOf(low.z, c); z <= cellOf(high.z, c); ++z) {
      for (int64_t y = cellOf(low.y, c); y <= cellOf(high.y, c); ++y) {
        for (int64_t x = cellOf(low.x, c); x <= cellOf(high.x, c); ++x)
          listed.emplace_back(packCell(x, y, z), i);
      }
    }
  }
  std::sort(listed.begin(), listed.end());
  listed.erase(std::unique(listed.begin(), listed.end()), listed.end());
  level.slots.resize(std::bit_ceil(2 * listed.size() + 1));
  level.mask = level.slots.size() - 1;
  for (size_t begin = 0; begin < listed.size();) {
    size_t end = begin;
    while (end < listed.size() && listed[end].first == listed[begin].first) {
      level.entries.push_back(listed[end++].second);
    }
    uint64_t slot = listed[begin].first & level.mask;
    while (level.slots[slot].begin != level.slots[slot].end) slot = (slot + 1) & level.mask;
    level.slots[slot] = {listed[begin].first, static_cast<uint32_t>(begin),
                         static_cast<uint32_t>(end)};
    begin = end;
  }
}

}  // namespace bnvpl
