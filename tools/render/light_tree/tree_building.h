// What the tree of the VPLs and trees of receivers are built from.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

namespace bnvpl {

// Length of a unit normal in the space that is split, over the diagonal of the positions' bounds.
inline constexpr float kNormalScale = 0.125f;

// How a node is divided: the elements whose coordinate along the axis is below `middle` come first.
struct NodeSplit {
  size_t first;  // their number
  uint8_t axis;
  float middle;
};

// Reorders the elements of a node: first those below the middle of the longest of six sides, or
// half of them if one part would be empty, as where all lie at one place. `coordinate(i,
// axis)` is the place of element i, with the scaled normal as axes 3 to 5.
template <typename Coordinate>
NodeSplit splitNode(std::span<uint32_t> elements, const Coordinate& coordinate) {
  std::array<float, 6> low, high;
  low.fill(INFINITY);
  high.fill(-INFINITY);
  for (const uint32_t i : elements) {
    for (size_t a = 0; a < 6; ++a) {
      low[a] = std::min(low[a], coordinate(i, a));
      high[a] = std::max(high[a], coordinate(i, a));
    }
  }
  size_t axis = 0;
  for (size_t a = 1; a < 6; ++a) {
    if (high[a] - low[a] > high[axis] - low[axis]) axis = a;
  }
  const float middle = 0.5f * (low[axis] + high[axis]);
  const auto cut = std::stable_partition(elements.begin(), elements.end(),
                                         [&](uint32_t i) { return coordinate(i, axis) < middle; });
  const auto first = static_cast<size_t>(cut - elements.begin());
  return {first > 0 && first < elements.size() ? first : elements.size() / 2,
          static_cast<uint8_t>(axis), middle};
}

}  // namespace bnvpl
