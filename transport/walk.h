// One step of a random walk: shared by place, photons, specular paths, path tracing and plots.
#pragma once

#include "transport/bsdf.h"

namespace bnvpl {

inline constexpr unsigned kMaxSpecular = 64;  // specular scatterings between two rough ones

// The group of lobes that a path takes at a vertex, and the probability of taking it.
struct LobeChoice {
  LobeGroup group;
  float probability;
  bool specular() const { return group == LobeGroup::Specular; }
};
// `roughImportance`: of the rough lobes' light, the part that is asked for, 0..1.
inline LobeChoice chooseLobes(const Bsdf& bsdf, Rng& rng, float roughImportance = 1.0f) {
  float specular = bsdf.specularProbability();
  if (roughImportance < 1.0f && specular > 0.0f) specular /= specular + (1.0f - specular) * roughImportance;
  return rng.next() < specular ? LobeChoice{LobeGroup::Specular, specular}
                               : LobeChoice{LobeGroup::Rough, 1.0f - specular};
}

// The ray that goes on from a vertex in a sampled direction.
inline Ray rayOn(const RayScene& rays, const SurfacePoint& vertex, const BsdfSample& sample) {
  return {rays.offsetOrigin(vertex.position, sample.side), sample.wi};
}

// Scatters by a group of lobes: `sample` has weight and density of the direction, `next` the ray
// that goes on. False: absorbed.
inline bool scatter(const RayScene& rays, const Bsdf& bsdf, LobeGroup group, Transport transport,
                    Rng& rng, BsdfSample& sample, Ray& next) {
  if (!bsdf.sample(group, transport, rng, sample)) return false;
  next = rayOn(rays, bsdf.point(), sample);
  return true;
}

}  // namespace bnvpl
