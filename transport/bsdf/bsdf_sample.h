// Types that the models of materials share with the code that evaluates them.
#pragma once

#include "core/random.h"
#include "core/sampling.h"
#include "transport/accelerator/accelerator.h"

namespace bnvpl {

// Reflection by lobes of at least this roughness is rough: VPLs represent it. A Phong lobe of
// exponent n has alpha = sqrt(2 / (n + 2)).
inline constexpr float kRoughAlpha = 0.3f;

// Rough: diffuse reflection, and glossy from kRoughAlpha on. Specular: mirrors, near-specular lobes
// below it, and all that crosses the surface. pbrt's Specular is delta lobes only; those have
// Bsdf::specularIsDelta().
enum class LobeGroup { Rough, Specular };

// The quantity that a path carries. It decides which normal the cosine refers to, and whether
// refraction scales the quantity (Veach 1997, chapter 5).
enum class TransportMode { Radiance, Importance };

struct BsdfSample {
  Vec3 wi;      // unit, away from the surface
  Vec3 weight;  // value * cosine / pdf
  float pdf;    // density of wi given the group, 1/sr; 0 for delta lobes
  Vec3 side;    // unit, the geometric normal on wi's side
};

// Bound of shadingFactor(). A photon at such grazing incidence would outweigh all others.
inline constexpr float kMaxShadingFactor = 1e5f;

// Factor |ns.wo| / |ng.wo| of a photon's flux from wo (Veach 1997, eq. 5.19): flux refers to the
// geometric normal, the BSDF to the shading normal. 0 where wo lies behind either normal.
inline float shadingFactor(const SurfacePoint& point, Vec3 normal) {
  const float geometric = dot(point.ng, point.wo);
  if (!(geometric > 0.0f)) return 0.0f;
  return std::min(kMaxShadingFactor, std::max(0.0f, dot(normal, point.wo)) / geometric);
}

}  // namespace bnvpl
