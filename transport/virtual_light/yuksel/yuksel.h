// Disks of points, by attenuation without singularity (--light yuksel); see theory.md.
#pragma once

#include <cmath>
#include <string_view>

#include "transport/virtual_light/lambert_emission.h"

namespace bnvpl {

// A disk of radius `size` of points that shine alike in all directions, seen from above its middle:
// the mean of 1/d^2 times the cosine is (2 / size^2) (1 - d / sqrt(d^2 + size^2)), which is exact
// at every distance and has no edge (Yuksel 2020, "Point Light Attenuation Without Singularity").
struct YukselLight : LambertEmission {
  static constexpr std::string_view name = "yuksel";
  template <typename F>
  static F boundedDistance2(F d2, F size2) {
    const F slant2 = d2 + size2;
    // The rounding of the root could lead below d2.
    return larger(broadcast<F>(0.5f) * (slant2 + squareRoot(d2 * slant2)), d2);
  }
  static float removed(float distanceOverSize) {
    if (!(distanceOverSize > 0.0f)) return 1.0f;
    const float size2 = 1.0f / (distanceOverSize * distanceOverSize);  // over d^2
    return 1.0f - 2.0f / (1.0f + size2 + std::sqrt(1.0f + size2));
  }
};

}  // namespace bnvpl
