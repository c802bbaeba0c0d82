// Point lights with a bound on 1/d^2 (--light point); see theory.md.
#pragma once

#include <string_view>

#include "transport/virtual_light/lambert_emission.h"

namespace bnvpl {

// A point light (Keller 1997) whose 1/d^2 is bounded within the distance `size` (Kollig & Keller
// 2006).
struct PointLight : LambertEmission {
  static constexpr std::string_view name = "point";
  template <typename F>
  static F boundedDistance2(F d2, F size2) {
    return larger(d2, size2);
  }
  static float removed(float distanceOverSize) {
    return larger(1.0f - distanceOverSize * distanceOverSize, 0.0f);
  }
};

}  // namespace bnvpl
