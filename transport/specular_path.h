// From a ray to the first rough vertex, through mirrors, glass and sharp lobes: the one definition
// of "specular path" for every integrator.
#pragma once

#include "transport/direct_light.h"

namespace bnvpl {

class SurfaceLights;

// Where sharp lobes look for lights; null: to one in proportion to its power.
struct LightsBehind {
  const LearnedStrata* first = nullptr;   // from the first specular vertex
  const SurfaceLights* others = nullptr;  // from all where `first` is not given
};

struct SpecularPath {
  bool rough = false;  // `hit` is a vertex where the rough lobes were taken
  SurfacePoint hit;
  Vec3 throughput;      // from the start to the hit, one over the probability of `rough` included
  unsigned links = 0;   // specular vertices passed
  bool spread = false;  // one of them at least by a sharp lobe: the direction was one of many
  Vec3 metFirst;        // emission met by the first segment
  Vec3 metLater;        // emission met behind specular vertices, and light sampled at sharp ones
  float firstDistance = INFINITY;  // of the first hit, along the ray
};

// `arrival`: at the first hit; its `shared` is for all that is met behind specular vertices.
SpecularPath followSpecularPath(const RayScene& rays, const LightSet& lights, Vec3 origin,
                                Vec3 direction, const Arrival& arrival, Rng& rng,
                                const LightsBehind& behind = {});
// The same where it is known what the ray hits; first.triangle is kNone where that is nothing.
// `roughImportance`: there, as of chooseLobes.
SpecularPath followSpecularPath(const RayScene& rays, const LightSet& lights,
                                const SurfacePoint& first, Vec3 direction, const Arrival& arrival,
                                Rng& rng, const LightsBehind& behind = {}, float roughImportance = 1.0f);

}  // namespace bnvpl
