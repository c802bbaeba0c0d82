// The camera's part of a path, the same for all integrators.
#pragma once

#include "tools/render/integrator/integrator.h"
#include "transport/specular_path.h"

namespace bnvpl {

// From the camera to the first rough vertex; what is met on the way is direct light.
inline SpecularPath seeFrom(const RayScene& rays, const LightSet& lights, Vec3 origin,
                            Vec3 direction, Rng& rng, RadianceSample& out,
                            const LightsBehind& behind = {}) {
  const SpecularPath end =
      followSpecularPath(rays, lights, origin, direction, Arrival{}, rng, behind);
  out.seen = end.metFirst;
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

// One camera path of an integrator that follows paths: leaving(bsdf, throughput, directOnly, out)
// adds the light that leaves the first rough vertex, or of it only what comes straight from a
// light. `indirect`: whether also the indirect light of points that the camera sees directly.
template <typename Leaving>
RadianceSample tracePath(const RayScene& rays, const LightSet& lights, const CameraSample& sample,
                         Only only, bool indirect, Rng& rng, const Leaving& leaving,
                         const LightsBehind& behind = {}) {
  RadianceSample out;
  const SpecularPath vertex =
      seeFrom(rays, lights, sample.origin, sample.direction, rng, out, behind);
  const bool directOnly = only == Only::Direct || (!indirect && vertex.links == 0);
  if (!vertex.rough) return out;
  const Bsdf bsdf(rays.scene(), vertex.hit);
  describeVertex(bsdf, out);
  if (directOnly && only == Only::Indirect) return out;
  leaving(bsdf, vertex.throughput, directOnly, out);
  return out;
}

}  // namespace bnvpl
