// Light that leaves a rough vertex, followed back to the lights path by path.
#pragma once

#include "transport/specular_path.h"
#include "transport/surface_lights.h"

namespace bnvpl {

struct PathLength {
  unsigned maxBounces;       // rough scatterings after the vertex
  bool firstBounce = false;  // only what came to the vertex straight from a light
};

// Adds throughput * radiance towards where the vertex is seen from, by light sampling and
// scattering with multiple importance sampling (Veach 1997, section 10): to `first` what comes to
// the vertex with nothing between it and a light, to `later` the rest. `at` is the vertex's own
// reflection, Bsdf(scene, vertex) or what stands for it. `where`: where light sampling looks for
// lights; null: everywhere, by power. Returns how many rough vertices the path
// had, this one included; each took about two rays.
unsigned addLeavingLight(const RayScene& rays, const LightSet& lights, const Bsdf& at,
                         Vec3 throughput, PathLength length, const SurfaceLights* where, Rng& rng,
                         Vec3& first, Vec3& later);

}  // namespace bnvpl
