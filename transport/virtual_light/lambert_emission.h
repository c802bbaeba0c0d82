// How VPLs and clusters of them emit, whatever their kind.
#pragma once

#include "core/lanes.h"
#include "core/vec3.h"

namespace bnvpl {

// Emits like a diffuse surface.
struct LambertEmission {
  static constexpr bool fromCentre = true;
  static float emitted(Vec3 axis, Vec3 toLight) { return -dot(axis, toLight); }
  // `cosine` is that of the direction with the axis of the cone, which has the given half angle.
  template <typename F>
  static F maxEmitted(F cosine, F cosHalfAngle, F sinHalfAngle) {
    const F zero = broadcast<F>(0.0f);
    const F nearest = cosSubClamped(cosine, cosHalfAngle, sinHalfAngle);
    return selectAtLeast(zero, cosHalfAngle, broadcast<F>(1.0f), larger(nearest, zero));
  }
  // `cosine` is the least of the direction with the axis of the cone.
  static float minEmitted(float cosine, float cosHalfAngle, float sinHalfAngle) {
    return larger(cosine * cosHalfAngle - sineOf(cosine) * sinHalfAngle, 0.0f) *
           (cosHalfAngle > 0.0f ? 1.0f : 0.0f);
  }
  // `subtended` is about half the angle that the cluster subtends, `sinHalfAngle` that of its cone.
  static float expectedEmitted(float cosine, float subtended, float sinHalfAngle) {
    return subtended + sinHalfAngle + cosine;
  }
};

}  // namespace bnvpl
