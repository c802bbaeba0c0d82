// Which of many disks reach a point: the inverse of a radius query, where every stored point has a
// radius of its own. Hash grids of cells twice as large from level to level; a disk is listed in
// the cells of its level that it touches (at most eight), so that a query reads one cell a level.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "core/random.h"
#include "core/vec3.h"

namespace bnvpl {

class ReachGrid {
 public:
  // Points and their radii (> 0, finite), world units.
  ReachGrid(std::span<const Vec3> points, std::span<const float> radii);

  // Calls fn(index, distanceSquared) for every point with distance < its radius, in a fixed order.
  template <typename Fn>
  void forEachReaching(Vec3 at, const Fn& fn) const {
    const Cell finest = cellOf(at);
    for (const Level& level : levels_) {
      const uint64_t key = keyOf(finest, level.shift);
      if (!level.mayHold(key)) continue;
      for (uint64_t slot = key & level.mask;; slot = (slot + 1) & level.mask) {
        const Slot& s = level.slots[slot];
        if (s.begin == s.end) break;  // empty: nothing reaches this cell
        if (s.key != key) continue;
        for (uint32_t k = s.begin; k < s.end; ++k) {
          const Disk& disk = level.disks[k];
          const float d2 = lengthSquared(disk.centre - at);
          if (d2 < disk.radiusSquared) fn(disk.index, d2);
        }
        break;
      }
    }
  }

 private:
  struct Cell {
    int64_t x, y, z;
  };
  struct Slot {
    uint64_t key = 0;
    uint32_t begin = 0, end = 0;
  };
  struct Disk {  // copied, so that a cell is read in one sweep
    Vec3 centre;
    float radiusSquared;
    uint32_t index;
  };
  struct Level {
    int shift = 0;  // of the finest level's cell numbers
    uint64_t mask = 0;
    std::vector<Slot> slots;  // open addressing, at most half full
    std::vector<Disk> disks;  // by cell
    // One bit for eight hash values each: most points that nothing reaches, which in a large scene
    // are most points, are told by these, which fit a cache.
    std::vector<uint64_t> filter;
    uint64_t filterMask = 0;

    bool mayHold(uint64_t key) const {
      const uint64_t bit = key >> 32 & filterMask;
      return (filter[bit / 64] >> (bit % 64) & 1) != 0;
    }
  };

  static int64_t floorOf(float v) {  // std::floor is a call on the baseline machine
    const float bounded = std::clamp(v, -1e15f, 1e15f);
    const auto whole = static_cast<int64_t>(bounded);
    return whole - (bounded < static_cast<float>(whole) ? 1 : 0);
  }
  Cell cellOf(Vec3 at) const {
    const Vec3 cells = (at - origin_) * cellsPerUnit_;
    return {floorOf(cells.x), floorOf(cells.y), floorOf(cells.z)};
  }
  // 21 bits an axis: cells a million apart share a list, which the test of distance sorts out.
  static uint64_t keyOf(Cell c, int shift) {
    constexpr uint64_t kAxisMask = (uint64_t{1} << 21) - 1;
    const auto bits = [&](int64_t v) { return static_cast<uint64_t>(v >> shift) & kAxisMask; };
    return mix64(bits(c.x) | bits(c.y) << 21 | bits(c.z) << 42);
  }
  void buildLevel(Level& level, const std::vector<uint32_t>& members, std::span<const Vec3> points,
                  std::span<const float> radii) const;

  Vec3 origin_;  // cells count from here, so that scenes far from the world's origin keep precision
  float cellsPerUnit_ = 1.0f;  // of the finest level: a power of two, so that all cells nest
  std::vector<Level> levels_;
};

}  // namespace bnvpl
