// What the models of materials and their users share.
#pragma once

#include "core/random.h"
#include "core/sampling.h"
#include "transport/rays.h"

namespace bnvpl {

// Roughness at and above which light is what VPLs stand for. A Phong lobe of exponent n has alpha =
// sqrt(2 / (n + 2)).
inline constexpr float kRoughAlpha = 0.3f;

enum class LobeGroup { Rough, Specular };

// What travels along a path changes two things: which normal the cosine belongs to, and whether
// refraction scales it (Veach 1997, chapter 5).
enum class Transport { Radiance, Photons };

struct BsdfSample {
  Vec3 wi;      // unit, away from the surface
  Vec3 weight;  // value * cosine / density
  float pdf;    // of wi in 1/sr, given the group; 0 for a perfect mirror or glass
  Vec3 side;    // normal of the side that the path leaves by
};

// So grazing that one photon would outweigh all others: no surface has such shading normals.
inline constexpr float kMaxShadingFactor = 1e5f;

// A photon's flux is measured against the geometric normal, shading against the shading normal:
// factor |ns.wo| / |ng.wo| of the flux that arrives from wo (Veach 1997, eq. 5.19).
inline float shadingFactor(const SurfacePoint& point, Vec3 normal) {
  const float geometric = dot(point.ng, point.wo);
  if (!(geometric > 0.0f)) return 0.0f;
  return std::min(kMaxShadingFactor, std::max(0.0f, dot(normal, point.wo)) / geometric);
}

}  // namespace bnvpl
