// Finds which of many disks reach a point: an inverse radius query, where every stored point has
// its own radius. There is a hash grid for each level, and cells double in size from level to
// level. A disk is listed in the cells of its level that its box overlaps (at most 27), so that a
// query reads one cell of each level.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/prefetch.h"
#include "core/random.h"
#include "core/vec3.h"
#include "spatial/cell_along.h"

namespace bnvpl {

class ReachGrid {
  struct Level;

 public:
  struct Disk {  // a copy, so that a cell's list is contiguous; two fit a cache line
    Vec3 centre;
    float radiusSquared;
    Vec3 normal;
    uint32_t index;
  };

  // Takes points, their normals and their radii (> 0, finite), world units.
  ReachGrid(std::span<const Vec3> points, std::span<const Vec3> normals,
            std::span<const float> radii);

  // The lists of disks that may reach a point.
  class Lookup {
    friend class ReachGrid;
    static constexpr int kMaxLevels = 24;
    static constexpr size_t kSweep = 32;  // number of disks tested before the callback runs
    struct List {
      const Level* level;
      uint64_t key;
      const Disk *begin, *end;
    };
    Vec3 at_;
    uint32_t size_ = 0;
    std::array<List, kMaxLevels> lists_;  // the first size_ are set
  };

  Lookup lookUp(Vec3 at) const {
    Lookup lookup;
    begin(at, lookup);
    find(lookup);
    return lookup;
  }
  // The same for many points, whose cache misses overlap. pointOf(i) may be null, to skip it.
  template <typename PointOf>
  void lookUpAll(size_t count, const PointOf& pointOf, std::span<Lookup> lookups) const {
    for (size_t i = 0; i < count; ++i) {
      if (const Vec3* at = pointOf(i)) begin(*at, lookups[i]);
    }
    for (size_t i = 0; i < count; ++i) {
      if (pointOf(i)) find(lookups[i]);
    }
  }

  // Calls fn(disk) for every disk whose centre is nearer than its radius (a ball test), in a fixed
  // order.
  template <typename Fn>
  static void forEachReaching(const Lookup& lookup, const Fn& fn) {
    for (uint32_t l = 0; l < lookup.size_; ++l) {
      const auto& list = lookup.lists_[l];
      for (const Disk* begin = list.begin; begin != list.end;) {
        const Disk* end = begin + std::min<ptrdiff_t>(Lookup::kSweep, list.end - begin);
        std::array<const Disk*, Lookup::kSweep + 1> reaching;
        size_t count = 0;
        for (; begin != end; ++begin) {  // without a branch, which would be mispredicted
          reaching[count] = begin;
          count += lengthSquared(begin->centre - lookup.at_) < begin->radiusSquared;
        }
        for (size_t i = 0; i < count; ++i) fn(*reaching[i]);
      }
    }
  }

 private:
  void begin(Vec3 at, Lookup& lookup) const {
    lookup.at_ = at;
    lookup.size_ = 0;
    const Cell finest = cellOf(at);
    for (const Level& level : levels_) {
      const uint64_t key = keyOf(finest, level.shift);
      prefetch(&level.slots[key & level.mask]);
      lookup.lists_[lookup.size_] = {&level, key, nullptr, nullptr};
      lookup.size_ += level.mayHold(key);  // without a branch, which would be mispredicted
    }
  }
  void find(Lookup& lookup) const {
    uint32_t found = 0;
    for (uint32_t l = 0; l < lookup.size_; ++l) {
      const Lookup::List list = lookup.lists_[l];
      const Slot& slot = list.level->slotOf(list.key);
      const Disk* disks = list.level->disks.data();
      prefetch(disks + slot.begin);
      lookup.lists_[found++] = {list.level, list.key, disks + slot.begin, disks + slot.end};
    }
    lookup.size_ = found;
  }

  struct Cell {
    int64_t x, y, z;
  };
  struct Slot {
    uint64_t key = 0;
    uint32_t begin = 0, end = 0;
  };
  struct Level {
    int shift = 0;  // right shift of the finest level's cell numbers
    uint64_t mask = 0;
    std::vector<Slot> slots;  // open addressing, at most half full
    std::vector<Disk> disks;  // by cell
    // A small hash filter that fits the cache. It rejects most points that no disk reaches, which
    // are the majority in a large scene.
    std::vector<uint64_t> filter;
    uint64_t filterMask = 0;

    bool mayHold(uint64_t key) const {
      const uint64_t bit = key >> 32 & filterMask;
      return (filter[bit / 64] >> (bit % 64) & 1) != 0;
    }
    // The slot of the key, or an empty one.
    const Slot& slotOf(uint64_t key) const {
      uint64_t slot = key & mask;
      while (slots[slot].begin != slots[slot].end && slots[slot].key != key)
        slot = (slot + 1) & mask;
      return slots[slot];
    }
  };

  Cell cellOf(Vec3 at) const {
    const Vec3 cells = (at - origin_) * cellsPerUnit_;
    return {cellAlong(cells.x), cellAlong(cells.y), cellAlong(cells.z)};
  }
  // Each axis has 21 bits. Cells two million apart share a list; the distance test tells them
  // apart.
  static uint64_t keyOf(Cell c, int shift) {
    constexpr uint64_t kAxisMask = (uint64_t{1} << 21) - 1;
    const auto bits = [&](int64_t v) { return static_cast<uint64_t>(v >> shift) & kAxisMask; };
    return mix64(bits(c.x) | bits(c.y) << 21 | bits(c.z) << 42);
  }
  void buildLevel(Level& level, const std::vector<uint32_t>& members, std::span<const Vec3> points,
                  std::span<const Vec3> normals, std::span<const float> radii) const;

  Vec3 origin_;                // origin of cells; keeps precision far from the world's origin
  float cellsPerUnit_ = 1.0f;  // at the finest level; a power of two, so that all cells nest
  std::vector<Level> levels_;
};

}  // namespace bnvpl
