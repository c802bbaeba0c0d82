// Light tracing (Dutre, Lafortune & Willems 1993), the adjoint of path tracing.
#pragma once

#include "tools/render/splat/splat.h"
#include "transport/lights.h"
#include "transport/photon_walk.h"

namespace bnvpl {

// Photons from the lights; each rough vertex but those of first-bounce light is connected with the
// camera. Brings the indirect light of points that the camera sees directly, unbiased and without
// a radius; what it sees over mirrors, glass and sharp lobes is left to the PathTracer. Has the
// path tracer's energy, and that of caustics of lights that no ray can hit besides. Rough
// scatterings after the first are limited to maxBounces, as the path tracer's.
class LightTracer {
 public:
  LightTracer(const RayScene& rays, const LightSet& lights, unsigned maxBounces, uint64_t seed);
  void follow(uint64_t begin, uint64_t end, Splats& out) const;

 private:
  void follow(PhotonWalk photon, uint64_t index, Splats& out) const;
  void followBranches(const PhotonWalk& photon, const SurfacePoint& hit, uint64_t index,
                      Splats& out) const;
  bool inSight(const SurfacePoint& vertex) const;
  void connect(const SurfacePoint& vertex, Vec3 flux, Splats& out) const;

  const RayScene& rays_;
  const LightSet& lights_;
  unsigned maxBounces_;
  uint64_t key_;
};

}  // namespace bnvpl
