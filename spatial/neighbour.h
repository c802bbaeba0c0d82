// The result of neighbour queries.
#pragma once

#include <cstdint>

namespace bnvpl {

struct Neighbour {
  float distanceSquared;  // lengthSquared(point - centre), world units squared
  uint32_t index;         // into the points that the structure was built over

  friend bool operator<(const Neighbour& a, const Neighbour& b) {
    return a.distanceSquared != b.distanceSquared ? a.distanceSquared < b.distanceSquared
                                                  : a.index < b.index;
  }
  friend bool operator==(const Neighbour&, const Neighbour&) = default;
};

}  // namespace bnvpl
