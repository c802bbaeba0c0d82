// The kinds of virtual light: how the light of one, or of a cluster of them, spreads. This is all
// that tells them apart, and the only place that knows it; values, upper bounds and expectations of
// every gather, the tree and the compensation ask it.
//
// A kind is a struct of static functions, named in LightKind and in withKind():
//   spread     what stands where d^2 of a point light would, so that light falls off with 1/spread;
//              must not fall with d2, and not lie below it
//   removed    share of a point light's 1/d^2 that it leaves out at a distance, which compensation
//              brings back: 1 - d^2 / spread
//   emitted    light in a direction, over that along the axis, times the distance
//   mostEmitted, expectedEmitted
//              the same for a cluster whose axes fill a cone, times nothing: an upper bound for
//              directions whose cosine with the cone's axis is at most so large, and a middling
//              value that is 0 only where nothing can be sent
// F is a float, or four of them (core/lanes.h).
#pragma once

#include <cstdint>
#include <string_view>

#include "core/lanes.h"
#include "core/vec3.h"

namespace bnvpl {

// Shines like a matt surface.
struct LambertEmission {
  static float emitted(Vec3 axis, Vec3 toLight) { return -dot(axis, toLight); }
  // `cosine` of the direction with the axis of a cone of axes with that half angle.
  template <typename F>
  static F mostEmitted(F cosine, F cosHalfAngle, F sinHalfAngle) {
    const F zero = everyLane<F>(0.0f);
    const F nearest = cosineOfLess(cosine, cosHalfAngle, sinHalfAngle);
    return selectAtLeast(zero, cosHalfAngle, everyLane<F>(1.0f), larger(nearest, zero));
  }
  // `halfAngle`: sine of half the angle that the cluster fills.
  static float expectedEmitted(float cosine, float halfAngle, float sinHalfAngle) {
    return halfAngle + sinHalfAngle + cosine;
  }
};

// A point whose 1/d^2 is bounded inside the distance `size` (Keller 1997; the bound: Kollig &
// Keller 2006).
struct PointLight : LambertEmission {
  template <typename F>
  static F spread(F d2, F size2) {
    return larger(d2, size2);
  }
  static float removed(float distanceOverSize) {
    return larger(1.0f - distanceOverSize * distanceOverSize, 0.0f);
  }
};

// A disk of radius `size`, by the form factor of a disk that faces the point, A cos cos / (pi d^2 +
// A): it is exact on the axis (Wallace, Elmquist & Haines 1989, "A Ray Tracing Algorithm for
// Progressive Radiosity").
struct DiskLight : LambertEmission {
  template <typename F>
  static F spread(F d2, F size2) {
    return d2 + size2;
  }
  static float removed(float distanceOverSize) {
    return 1.0f / (1.0f + distanceOverSize * distanceOverSize);
  }
};

enum class LightKind : uint8_t { Point, Disk };
inline constexpr std::string_view kLightKinds = "point|disk";
inline LightKind lightKindNamed(std::string_view name) {
  return name == "disk" ? LightKind::Disk : LightKind::Point;
}

// Calls fn with the struct of a kind.
template <typename Fn>
auto withKind(LightKind kind, const Fn& fn) {
  return kind == LightKind::Disk ? fn(DiskLight{}) : fn(PointLight{});
}

// 1/d^2 as the kind has it, 1/m2.
inline float falloff(LightKind kind, float distanceSquared, float size2) {
  return 1.0f / withKind(kind, [&](auto k) { return k.spread(distanceSquared, size2); });
}

}  // namespace bnvpl
