// Which of many disks reach a point: the inverse of a radius query, where every stored point has a
// radius of its own. Hash grids of cells twice as large from level to level; a disk is listed in
// the cells of its level that it touches (at most eight), so that a query reads one cell a level.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec3.h"

namespace bnvpl {

class ReachGrid {
 public:
  // Borrows both spans: points and their radii (> 0, finite), world units.
  ReachGrid(std::span<const Vec3> points, std::span<const float> radii);

  // Calls fn(index, distanceSquared) for every point with distance < its radius, in a fixed order.
  template <typename Fn>
  void forEachReaching(Vec3 at, const Fn& fn) const {
    for (const Level& level : levels_) {
      const uint64_t key = cellKey(at, level.cellSize);
      for (uint64_t slot = key & level.mask;; slot = (slot + 1) & level.mask) {
        const Slot& s = level.slots[slot];
        if (s.begin == s.end) break;  // empty: nothing reaches this cell
        if (s.key != key) continue;
        for (uint32_t k = s.begin; k < s.end; ++k) {
          const uint32_t i = level.entries[k];
          const float d2 = lengthSquared(points_[i] - at);
          if (d2 < radii_[i] * radii_[i]) fn(i, d2);
        }
        break;
      }
    }
  }

 private:
  struct Slot {
    uint64_t key = 0;
    uint32_t begin = 0, end = 0;
  };
  struct Level {
    float cellSize = 1.0f;
    uint64_t mask = 0;
    std::vector<Slot> slots;        // open addressing, at most half full
    std::vector<uint32_t> entries;  // disks by cell
  };
  uint64_t cellKey(Vec3 at, float cellSize) const;
  void buildLevel(Level& level, const std::vector<uint32_t>& members);

  std::span<const Vec3> points_;
  std::span<const float> radii_;
  Vec3 origin_;  // cells count from here, so that scenes far from the world's origin keep precision
  std::vector<Level> levels_;
};

}  // namespace bnvpl
