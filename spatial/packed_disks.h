// Disks in their densest packing. Each takes a hexagon of area 2 sqrt(3) r^2 (docs/theory.md, 4).
#pragma once

#include <cmath>

namespace bnvpl {

// Area that a disk of this radius takes.
template <typename T>
T packedDiskArea(T radius) {
  return T(2) * std::sqrt(T(3)) * radius * radius;
}

// Radius of `count` equal disks that take this area together.
template <typename T>
T packedDiskRadius(T area, T count = T(1)) {
  return std::sqrt(area / (T(2) * std::sqrt(T(3)) * count));
}

}  // namespace bnvpl
