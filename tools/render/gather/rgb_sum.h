// Sums of light in double precision.
#pragma once

#include <algorithm>

#include "core/vec3.h"

namespace bnvpl {

// Has double precision because refining a cut adds and subtracts thousands of terms.
struct RgbSum {
  double r = 0, g = 0, b = 0;
  void add(Vec3 v, double sign = 1.0) {
    r += sign * double{v.x};
    g += sign * double{v.y};
    b += sign * double{v.z};
  }
  double sum() const { return r + g + b; }
  Vec3 toVec3() const {  // clamps channels at 0
    return {static_cast<float>(std::max(0.0, r)), static_cast<float>(std::max(0.0, g)),
            static_cast<float>(std::max(0.0, b))};
  }
};

}  // namespace bnvpl
