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
//              it comes from a sphere of radius `size`, spherical/spherical_transfer.h
//              integrates it, and its falloff is a typical value; minDistance2() bounds it
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

#include "transport/virtual_light/disk/disk.h"
#include "transport/virtual_light/point/point.h"
#include "transport/virtual_light/spherical/spherical.h"
#include "transport/virtual_light/yuksel/yuksel.h"

namespace bnvpl {

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
