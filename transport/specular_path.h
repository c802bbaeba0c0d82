// Follows a ray through mirrors, glass and near-specular lobes to the first rough vertex. All
// integrators share this definition of a specular path.
#pragma once

#include "transport/direct_light/direct_light.h"

namespace bnvpl {

class SpatialLightSampler;

// Distributions by which near-specular vertices sample lights; without one, they sample by power.
// Also where the light of a specular path goes by group.
struct SpecularLightSampling {
  const LearnedStrata* first = nullptr;         // for the first specular vertex
  const SpatialLightSampler* others = nullptr;  // for the others, and for the first without `first`
  LightGroupSink firstSegmentEmission = {},
                 lightOverSpecular = {};  // receive the members of SpecularPath
  bool wanted = true;  // whether near-specular vertices sample lights; else their light is missing
};

struct SpecularPath {
  bool rough = false;  // whether the path took the rough lobes at `hit`
  SurfacePoint hit;
  Vec3 throughput;  // from the start to the hit, over the probability of choosing `rough`
  unsigned specularBounces = 0;  // number of specular vertices
  bool hasNonDelta = false;      // whether one of them has a near-specular rather than a delta lobe
  Vec3 firstSegmentEmission;     // emission hit by the first segment
  Vec3 lightOverSpecular;        // emission hit later, and light sampled at near-specular vertices
  float firstDistance = INFINITY;  // distance of the first hit along the ray
};

// `arrival` describes the first segment; its `photons` hold for the segments behind specular
// vertices, and with a misRatio for the first, too.
SpecularPath followSpecularPath(const Accelerator& accel, const LightSet& lights, Vec3 origin,
                                Vec3 direction, const Arrival& arrival, Rng& rng,
                                const SpecularLightSampling& specularLights = {});
// The same with a given first hit; first.triangle is kNone if the ray leaves the scene.
// `roughImportance` is passed to chooseLobes() at the first hit.
SpecularPath followSpecularPath(const Accelerator& accel, const LightSet& lights,
                                const SurfacePoint& first, Vec3 direction, const Arrival& arrival,
                                Rng& rng, const SpecularLightSampling& specularLights = {},
                                float roughImportance = 1.0f);

}  // namespace bnvpl
