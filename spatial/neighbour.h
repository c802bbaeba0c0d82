// What neighbour queries answer. KdTree answers
//   void withinRadius(Vec3 centre, float radius, std::vector<Neighbour>& found) const;
// so that templates can take either. Both borrow the points, which must outlive them unchanged, and
// both may be queried from any number of threads at once.
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
