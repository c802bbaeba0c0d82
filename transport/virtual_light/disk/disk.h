// Disks that face the receiver (--light disk); see theory.md.
#pragma once

#include <string_view>

#include "transport/virtual_light/lambert_emission.h"

namespace bnvpl {

// A disk of radius `size`, by the form factor A cos cos / (pi d^2 + A) of a disk that faces the
// point, which is exact on the axis (Wallace, Elmquist & Haines 1989, "A Ray Tracing Algorithm for
// Progressive Radiosity").
struct DiskLight : LambertEmission {
  static constexpr std::string_view name = "disk";
  template <typename F>
  static F boundedDistance2(F d2, F size2) {
    return d2 + size2;
  }
  static float removed(float distanceOverSize) {
    return 1.0f / (1.0f + distanceOverSize * distanceOverSize);
  }
};

}  // namespace bnvpl
