// Finds the disk that represents a point, among many disks on surfaces. A hash table has one disk
// for each cell and each of six facings of normals, so that a query reads one entry of each level.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec3.h"

namespace bnvpl {

class RegionGrid {
 public:
  RegionGrid() = default;
  // Takes points, their unit normals and their radii (> 0, finite), world units.
  RegionGrid(std::span<const Vec3> points, std::span<const Vec3> normals,
             std::span<const float> radii);

  // Index of a disk near the point on a similar surface, or UINT32_MAX if there is none. All points
  // of a cell with the same facing have the same disk.
  uint32_t at(Vec3 position, Vec3 normal) const;

 private:
  struct Slot {
    uint64_t key = 0;
    uint32_t index = UINT32_MAX;
  };
  struct Entry;
  void list(uint32_t index, Vec3 point, Vec3 normal, float radius, std::vector<Entry>& out) const;
  void fill(std::vector<Entry>& entries);

  Vec3 origin_;                 // origin of cell numbers
  std::vector<int> levels_;     // binary exponents of the cell widths, ascending
  std::vector<float> perUnit_;  // cells per unit of each level
  std::vector<Slot> slots_;     // open addressing, at most half full
  uint64_t mask_ = 0;
};

}  // namespace bnvpl
