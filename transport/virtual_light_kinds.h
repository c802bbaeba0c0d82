// Kinds of virtual light: the emission and falloff of a VPL, and of a cluster of VPLs. Gathers,
// light tree and compensation take their values, upper bounds and expectations from here.
//
// A kind is a struct of static functions, and an entry of the list VplKinds:
//   name       value of the command-line option
//   boundedDistance2
//              replaces d^2, so that light falls off with 1/boundedDistance2; it must be at least
//              d2 and not decrease with d2
//   removed    share of a point light's 1/d^2 that the kind leaves out at a distance, and that
//              compensation adds back: 1 - d^2 / boundedDistance2; 0 for spheres, which move it
//   fromCentre whether the light is the product of BSDF, cosines and falloff towards the VPL. Else
//              it comes from a sphere of radius `size`, transport/spherical_light.h integrates it,
//              and its falloff is a typical value; minDistance2() bounds it
//   emitted    emission in a direction relative to that along the axis, times the distance
//   maxEmitted, minEmitted, expectedEmitted
//              the same for a cluster whose axes fill a cone, without the distance: an upper bound
//              for directions whose cosine with the cone's axis is at most the given one, a lower
//              bound for those where it is at least that, and a typical value that is 0 only where
//              nothing can be emitted
// F is a float, or four of them (core/lanes.h).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

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

// What replaces d^2 in an upper bound of the light of VPLs at least `size` large, whose box
// (VplLights::box) is at the given distance.
template <typename Kind, typename F>
F minDistance2(F box2, F size2) {
  if constexpr (Kind::fromCentre) {
    return Kind::boundedDistance2(box2, size2);
  } else {
    return Kind::minDistance2(box2, size2);
  }
}

template <typename... Kinds>
struct KindList {
  static constexpr std::array<std::string_view, sizeof...(Kinds)> names{Kinds::name...};
  // "point|disk|yuksel|spherical"
  static constexpr auto choices = [] {
    std::array<char, (Kinds::name.size() + ...) + sizeof...(Kinds) - 1> text{};
    auto at = text.begin();
    for (const std::string_view name : {Kinds::name...}) {
      if (at != text.begin()) *at++ = '|';
      at = std::copy(name.begin(), name.end(), at);
    }
    return text;
  }();
};

// Every kind; the first is the default.
using VplKinds = KindList<PointLight, DiskLight, YukselLight, SphericalLight>;
inline constexpr std::string_view kLightKinds{VplKinds::choices.data(), VplKinds::choices.size()};

enum class VplKind : uint8_t {};  // an index into VplKinds

// Throws std::logic_error if no kind has that name.
inline VplKind vplKindNamed(std::string_view name) {
  for (size_t i = 0; i < VplKinds::names.size(); ++i) {
    if (VplKinds::names[i] == name) return VplKind(i);
  }
  throw std::logic_error("no kind of light " + std::string(name));
}

template <typename Fn, typename First, typename... Rest>
auto withKindOf(KindList<First, Rest...>, size_t place, const Fn& fn) {
  if constexpr (sizeof...(Rest) == 0) {
    return fn(First{});
  } else {
    return place == 0 ? fn(First{}) : withKindOf(KindList<Rest...>{}, place - 1, fn);
  }
}

// Calls fn with the struct of a kind.
template <typename Fn>
auto withKind(VplKind kind, const Fn& fn) {
  return withKindOf(VplKinds{}, static_cast<size_t>(kind), fn);
}

inline bool isFromCentre(VplKind kind) {
  return withKind(kind, [](auto k) { return k.fromCentre; });
}

// The kind's falloff, which replaces 1/d^2, in 1/m2.
inline float falloff(VplKind kind, float distanceSquared, float size2) {
  return 1.0f / withKind(kind, [&](auto k) { return k.boundedDistance2(distanceSquared, size2); });
}
// Its upper bound for VPLs whose box is at that distance, 1/m2.
inline float maxFalloff(VplKind kind, float boxDistanceSquared, float size2) {
  return 1.0f / withKind(kind, [&](auto k) {
           return minDistance2<decltype(k)>(boxDistanceSquared, size2);
         });
}

}  // namespace bnvpl
