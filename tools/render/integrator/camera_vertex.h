// The camera's part of a path, the same for all integrators.
#pragma once

#include "tools/render/integrator/integrator.h"
#include "transport/specular_path.h"

namespace bnvpl {

// From the camera to the first rough vertex; what is met on the way is direct light.
inline SpecularPath seeFrom(const RayScene& rays, const LightSet& lights, Vec3 origin,
                            Vec3 direction, Rng& rng, RadianceSample& out) {
  const SpecularPath end = followSpecularPath(rays, lights, origin, direction, Arrival{}, rng);
  out.direct = end.metFirst + end.metLater;
  if (end.firstDistance < INFINITY) {
    out.depth = end.firstDistance * dot(direction, rays.scene().camera.forward);
  }
  return end;
}

// Albedo and normal of that vertex.
inline void describeVertex(const Bsdf& bsdf, RadianceSample& out) {
  out.albedo = bsdf.roughAlbedo();
  out.normal = bsdf.point().ns;
}

}  // namespace bnvpl
