// Light that leaves a rough vertex, estimated by path tracing.
#pragma once

#include "transport/direct_light/spatial_light_sampler.h"
#include "transport/specular_path.h"

namespace bnvpl {

struct PathLength {
  unsigned maxBounces;      // max number of rough scatterings after the vertex
  bool directOnly = false;  // whether to estimate only the vertex's direct light
};

// Receive `direct` and `indirect` of addOutgoingRadiance() by group.
struct OutgoingGroups {
  LightGroupSink direct, indirect;
};

// Adds throughput * radiance towards wo of the vertex, by light sampling and scattering with
// multiple importance sampling (Veach 1997, section 9.2). `direct` gets the direct light of
// the vertex, `indirect` the rest. `start` is the vertex's BSDF, or one that represents it.
// `lightSampler` has the distributions by which lights are sampled; null: by power. Returns the
// number of rough vertices of the path, this one included; each takes about two rays. `photons`:
// weights of light that photons estimate, too.
unsigned addOutgoingRadiance(const Accelerator& accel, const LightSet& lights, const Bsdf& start,
                             Vec3 throughput, PathLength length,
                             const SpatialLightSampler* lightSampler, Rng& rng, Vec3& direct,
                             Vec3& indirect, const OutgoingGroups& groups = {},
                             const PhotonMis& photons = {});

}  // namespace bnvpl
