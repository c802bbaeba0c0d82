// One step of a random walk, for candidates, photons, specular paths, path tracing and plots.
#pragma once

#include "transport/bsdf.h"

namespace bnvpl {

inline constexpr unsigned kMaxSpecular = 64;  // max specular scatterings between two rough ones

// The group of lobes that a path takes at a vertex, and its probability.
struct LobeChoice {
  LobeGroup group;
  float probability;
  bool specular() const { return group == LobeGroup::Specular; }
};
// Probability of the specular group. `roughImportance` scales that of the rough group before
// normalisation, 0..1.
inline float specularProbability(const Bsdf& bsdf, float roughImportance) {
  const float specular = bsdf.specularProbability();
  return roughImportance < 1.0f && specular > 0.0f
             ? specular / (specular + (1.0f - specular) * roughImportance)
             : specular;
}
inline LobeChoice chooseLobes(const Bsdf& bsdf, Rng& rng, float roughImportance = 1.0f) {
  const float specular = specularProbability(bsdf, roughImportance);
  return rng.next() < specular ? LobeChoice{LobeGroup::Specular, specular}
                               : LobeChoice{LobeGroup::Rough, 1.0f - specular};
}

// The ray from a vertex in a sampled direction.
inline Ray spawnRay(const Accelerator& accel, const SurfacePoint& vertex,
                    const BsdfSample& sample) {
  return {accel.offsetOrigin(vertex.position, sample.side), sample.wi};
}

// Samples a direction from a group of lobes, and sets `next` to the ray in this direction. Returns
// false if the path is absorbed.
inline bool sampleNextRay(const Accelerator& accel, const Bsdf& bsdf, LobeGroup group,
                          TransportMode transport, Rng& rng, BsdfSample& sample, Ray& next) {
  if (!bsdf.sample(group, transport, rng, sample)) return false;
  next = spawnRay(accel, bsdf.point(), sample);
  return true;
}

// Probability of going on by which Russian roulette follows the weight of a scattered ray.
inline float rouletteSurvival(const BsdfSample& sample) {
  return std::min(1.0f, maxComponent(sample.weight));
}

}  // namespace bnvpl
