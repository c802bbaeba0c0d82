// Candidate pairs of near points, where each point has its own radius: the points in the order of
// their cells, and for each cell the ranges of this order that may hold partners. Only
// cell_lists.cpp includes OpenVDB.
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

  std::vector<uint32_t> order;       // original index of the k-th point by cell; may be emptied
  std::vector<uint32_t> cellOf;      // cell of the k-th point
  std::vector<uint32_t> firstRange;  // first range of each cell; cells + 1 entries
  std::vector<Range> ranges;         // ranges of k; disjoint and ascending within each cell

  // Ranges that hold every point, the k-th included, whose distance from the k-th is less than the
  // sum of both radii.
  std::span<const Range> near(uint32_t k) const {
    const uint32_t cell = cellOf[k];
    return {ranges.data() + firstRange[cell], firstRange[cell + 1] - firstRange[cell]};
  }

  // Removes the points whose `keep` is 0, and keeps the order of the others.
  void compact(std::span<const uint8_t> keep);
};

// Radii are positive and finite, world units. Points whose radii have the same power of two share a
// grid (OpenVDB's point index grid) with cells of two radii, so that all cells hold about equally
// many points if the radii follow the density. Points in Morton order (mortonOrder) make it faster.
CellLists makeCellLists(std::span<const Vec3> points, std::span<const float> radii);

}  // namespace bnvpl
