// Spheres, whose light spherical_transfer.h integrates (--light spherical); see theory.md.
#pragma once

#include <string_view>

#include "transport/virtual_light/lambert_emission.h"

namespace bnvpl {

// A sphere of radius `size` (Hasan et al. 2009), which moves near light instead of removing it. Its
// falloff is that towards a surface that faces it.
//
// Bounds: the light is a mean over directions of the sphere, so that it is at most the largest BSDF
// times cosines towards any point of the sphere, times its solid angle over the disk pi size^2,
//   2 / (d^2 + d sqrt(d^2 - size^2)),  for d < size that of the hemisphere, 2 / size^2.
// d is the distance of the centre, at least that of the sphere's box plus `size`.
struct SphericalLight : LambertEmission {
  static constexpr std::string_view name = "spherical";
  static constexpr bool fromCentre = false;
  template <typename F>
  static F boundedDistance2(F d2, F size2) {
    const F outside2 = larger(d2, size2), one = broadcast<F>(1.0f);
    const F cos2 = one - size2 / outside2, cosine = squareRoot(cos2);
    return larger(broadcast<F>(1.5f) * outside2 * (one + cosine) / (one + cosine + cos2), d2);
  }
  // Replaces d^2 in bounds. `box2`: squared distance to a box that holds the sphere.
  template <typename F>
  static F minDistance2(F box2, F size2) {
    const F d = squareRoot(box2) + squareRoot(size2), d2 = d * d;
    return broadcast<F>(0.5f) * (d2 + d * squareRoot(larger(d2 - size2, broadcast<F>(0.0f))));
  }
  static float removed(float) { return 0.0f; }
};

}  // namespace bnvpl
