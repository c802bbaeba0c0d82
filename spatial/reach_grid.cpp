#include "spatial/reach_grid.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>

namespace bnvpl {

ReachGrid::ReachGrid(std::span<const Vec3> points, std::span<const Vec3> normals,
                     std::span<const float> radii) {
  if (points.empty()) return;
  origin_ = points[0];
  // Each level has the radii of one power of two. A cell is one to two radii wide: wider cells have
  // longer lists, narrower cells make more entries.
  std::map<int, std::vector<uint32_t>> byExponent;
  for (size_t i = 0; i < points.size(); ++i) {
    byExponent[std::ilogb(radii[i])].push_back(static_cast<uint32_t>(i));
  }
  constexpr int kFinestOfAll = -100;  // cell numbers of denormal radii would overflow
  const int finest = std::max({byExponent.begin()->first, kFinestOfAll,
                               byExponent.rbegin()->first - (Lookup::kMaxLevels - 1)});
  for (auto below = byExponent.begin(); below->first < finest; below = byExponent.begin()) {
    auto& members = byExponent[finest];
    members.insert(members.end(), below->second.begin(), below->second.end());
    byExponent.erase(below);
  }
  cellsPerUnit_ = std::ldexp(1.0f, -finest - 1);
  for (const auto& [exponent, members] : byExponent) {
    levels_.emplace_back().shift = exponent - finest;
    buildLevel(levels_.back(), members, points, normals, radii);
  }
}

void ReachGrid::buildLevel(Level& level, const std::vector<uint32_t>& members,
                           std::span<const Vec3> points, std::span<const Vec3> normals,
                           std::span<const float> radii) const {
  std::vector<std::pair<uint64_t, uint32_t>> listed;  // cell, disk
  const int64_t step = int64_t{1} << level.shift;
  for (const uint32_t i : members) {
    const Cell low = cellOf(points[i] - Vec3{radii[i]}), high = cellOf(points[i] + Vec3{radii[i]});
    const auto first = [&](int64_t v) { return v >> level.shift << level.shift; };
    for (int64_t z = first(low.z); z <= high.z; z += step) {
      for (int64_t y = first(low.y); y <= high.y; y += step) {
        for (int64_t x = first(low.x); x <= high.x; x += step)
          listed.emplace_back(keyOf({x, y, z}, level.shift), i);
      }
    }
  }
  tbb::parallel_sort(listed.begin(), listed.end());  // deterministic, because the order is total
  listed.erase(std::unique(listed.begin(), listed.end()), listed.end());
  size_t cells = 0;
  for (size_t k = 0; k < listed.size(); ++k) {
    cells += k == 0 || listed[k].first != listed[k - 1].first;
  }
  level.slots.resize(std::bit_ceil(2 * cells + 1));
  level.mask = level.slots.size() - 1;
  level.filter.resize(std::bit_ceil(8 * cells / 64 + 1));
  level.filterMask = 64 * level.filter.size() - 1;
  level.disks.reserve(listed.size());
  for (size_t begin = 0; begin < listed.size();) {
    size_t end = begin;
    while (end < listed.size() && listed[end].first == listed[begin].first) {
      const uint32_t i = listed[end++].second;
      level.disks.push_back({points[i], radii[i] * radii[i], normals[i], i});
    }
    const uint64_t key = listed[begin].first, bit = key >> 32 & level.filterMask;
    level.filter[bit / 64] |= uint64_t{1} << (bit % 64);
    uint64_t slot = key & level.mask;
    while (level.slots[slot].begin != level.slots[slot].end) slot = (slot + 1) & level.mask;
    level.slots[slot] = {key, static_cast<uint32_t>(begin), static_cast<uint32_t>(end)};
    begin = end;
  }
}

}  // namespace bnvpl
