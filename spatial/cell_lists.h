// Who may be near whom, for points that each have a radius of their own: points in the order of
// the cells that they lie in, and for each cell the ranges of that order that can hold a partner.
// The only OpenVDB include is in cell_lists.cpp.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec3.h"

namespace bnvpl {

struct CellLists {
  struct Range {
    uint32_t begin, end;
    friend bool operator<(const Range& a, const Range& b) { return a.begin < b.begin; }
    friend bool operator==(const Range&, const Range&) = default;
  };

  std::vector<uint32_t> order;       // the given index of the k-th point by cell; may be emptied
  std::vector<uint32_t> cellOf;      // the cell of the k-th point
  std::vector<uint32_t> firstRange;  // of each cell; cells + 1 entries
  std::vector<Range> ranges;         // over k, of all cells, disjoint and ascending in each

  // Every point at less than the sum of both radii from the k-th is in one of these, itself too.
  std::span<const Range> near(uint32_t k) const {
    const uint32_t cell = cellOf[k];
    return {ranges.data() + firstRange[cell], firstRange[cell + 1] - firstRange[cell]};
  }

  // Leaves out the points whose `keep` is 0; the order of the rest stays.
  void compact(std::span<const uint8_t> keep);
};

// Radii are positive and finite, world units. Points with radii of one power of two share a grid
// whose cells are two radii wide (OpenVDB's point index grid), so that a cell holds about as many
// points where they are dense as where they are rare, if the radii follow the density. Points in an
// order that keeps neighbours together (mortonOrder) make it faster.
CellLists makeCellLists(std::span<const Vec3> points, std::span<const float> radii);

}  // namespace bnvpl
