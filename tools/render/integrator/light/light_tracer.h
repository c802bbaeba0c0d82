// Light tracing (Dutre, Lafortune & Willems 1993), the adjoint of path tracing.
#pragma once

#include "tools/render/pixel_filter.h"
#include "tools/render/splat/splat.h"
#include "transport/lights/lights.h"
#include "transport/photons/photon_walk.h"

namespace bnvpl {

// Traces photons from the lights and connects each of their rough vertices, except those of
// first-bounce light, with the camera. This is an unbiased estimate of the indirect light of points
// that the camera sees directly. The PathTracer adds what is seen over mirrors, glass and
// near-specular lobes. The expectation is that of the path tracer, plus caustics of lights that no
// ray can hit. Rough scatterings after the first are limited to maxBounces, as in the path tracer.
class LightTracer {
 public:
  LightTracer(const Accelerator& accel, const LightSet& lights, const PixelFilter& filter,
              unsigned maxBounces, uint64_t seed);
  void follow(uint64_t begin, uint64_t end, Splats& out) const;

 private:
  // `lens`: the point of the lens with which the photon's vertices are connected. `group`: the
  // light group of the photon.
  void follow(PhotonWalk photon, Vec3 lens, uint64_t index, uint32_t group, Splats& out) const;
  void followBranches(const PhotonWalk& photon, const SurfacePoint& hit, uint64_t index,
                      uint32_t group, Splats& out) const;
  bool inSight(const SurfacePoint& vertex) const;
  void connect(const SurfacePoint& vertex, Vec3 lens, Vec3 flux, uint32_t group, Splats& out) const;

  const Accelerator& accel_;
  const LightSet& lights_;
  PixelFilter filter_;
  unsigned maxBounces_;
  uint64_t key_;
};

}  // namespace bnvpl
