// Which of many disks on surfaces speaks for a point: a table of cells, with a disk for each cell
// and each of six directions of normals, so that a query reads one entry a level.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec3.h"

namespace bnvpl {

class RegionGrid {
 public:
  RegionGrid() = default;
  // Points, their unit normals and their radii (> 0, finite), world units.
  RegionGrid(std::span<const Vec3> points, std::span<const Vec3> normals,
             std::span<const float> radii);

  // The index of a disk near the point, on a surface like its own; UINT32_MAX: there is none. A
  // choice that a cell makes for all its points.
  uint32_t at(Vec3 position, Vec3 normal) const;

 private:
  struct Slot {
    uint64_t key = 0;
    uint32_t index = UINT32_MAX;
  };
  struct Entry;
  void list(uint32_t index, Vec3 point, Vec3 normal, float radius, std::vector<Entry>& out) const;
  void fill(std::vector<Entry>& entries);

  Vec3 origin_;                 // cells count from here
  std::vector<int> levels_;     // binary exponents of the cells' widths, ascending
  std::vector<float> perUnit_;  // cells, of each level
  std::vector<Slot> slots_;     // open addressing, at most half full
  uint64_t mask_ = 0;
};

}  // namespace bnvpl
