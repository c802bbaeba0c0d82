// The first part of a camera path, from the camera to the shading point; the same for all
// integrators.
#pragma once

#include <vector>

#include "core/sampling.h"
#include "tools/render/pixel_filter.h"
#include "tools/render/sample.h"
#include "transport/camera.h"
#include "transport/specular_path.h"

namespace bnvpl {

// Follows a camera ray to the first rough vertex. Emission that it hits on the way is direct light.
// `weight`, by the pixel filter, becomes part of the throughput and of all light. `groups`
// receives emission and direct light by light group.
inline SpecularPath traceCameraPath(const Accelerator& accel, const LightSet& lights, Vec3 origin,
                                    Vec3 direction, float weight, Rng& rng, RadianceSample& out,
                                    const SpecularLightSampling& specularLights = {},
                                    const SampleGroups& groups = {}) {
  // Where the film is transparent, emission waits for the hit that tells it from the background.
  const bool hidesSky = accel.scene().film.transparent;
  std::vector<Vec3> waiting(hidesSky ? groups.count : 0);
  SpecularLightSampling sampling = specularLights;
  if (groups.sums) {
    sampling.firstSegmentEmission = (hidesSky ? sinkTo(waiting) : groups.emission()).times(weight);
    sampling.lightOverSpecular = groups.direct().times(weight);
  }
  SpecularPath path =
      followSpecularPath(accel, lights, origin, direction, Arrival{}, rng, sampling);
  if (weight != 1.0f) {
    for (Vec3* part : {&path.throughput, &path.firstSegmentEmission, &path.lightOverSpecular})
      *part *= weight;
  }
  const bool sky = path.firstDistance == INFINITY;
  if (hidesSky && sky) path.firstSegmentEmission = {};
  for (uint32_t g = 0; !sky && g < waiting.size(); ++g) groups.emission().add(g, waiting[g]);
  out.emission = path.firstSegmentEmission;
  out.direct = path.firstSegmentEmission + path.lightOverSpecular;
  if (path.firstDistance < INFINITY) {
    out.depth = path.firstDistance * dot(direction, accel.scene().camera.forward);
  }
  return path;
}

// The same for a camera ray of a pixel, at a place that its filter gives. A lens takes the next
// point of `rng`.
inline SpecularPath traceCameraPath(const Accelerator& accel, const LightSet& lights, uint32_t x,
                                    uint32_t y, const PixelFilter::Sample& sample, Rng& rng,
                                    RadianceSample& out,
                                    const SpecularLightSampling& specularLights = {},
                                    const SampleGroups& groups = {}) {
  const Scene& scene = accel.scene();
  const Vec3 lens = sampleLens(scene.camera, [&] { return rng.nextPoint(); });
  const Ray ray = cameraRay(scene.camera, scene.film,
                            (static_cast<float>(x) + sample.at.x) / float(scene.film.width),
                            (static_cast<float>(y) + sample.at.y) / float(scene.film.height), lens);
  return traceCameraPath(accel, lights, ray.origin, ray.direction, sample.weight, rng, out,
                         specularLights, groups);
}

// Albedo and normal of the shading point.
inline void describeShadingPoint(const Bsdf& bsdf, RadianceSample& out) {
  out.albedo = bsdf.roughAlbedo();
  out.normal = bsdf.point().ns;
}

// One camera path of an integrator that traces paths. leaving(bsdf, throughput, directOnly, out)
// adds the light that leaves the shading point, or if `directOnly` the part of it that comes from
// the lights without another bounce. `indirect`: whether indirect light is wanted at points that
// the camera sees without a specular vertex between.
template <typename Leaving>
RadianceSample tracePath(const Accelerator& accel, const LightSet& lights,
                         const CameraSample& sample, ShownLight shown, bool indirect, Rng& rng,
                         const Leaving& leaving, const SpecularLightSampling& specularLights = {}) {
  RadianceSample out;
  const SpecularPath path = traceCameraPath(accel, lights, sample.origin, sample.direction,
                                            sample.weight, rng, out, specularLights, sample.groups);
  const bool directOnly = shown == ShownLight::Direct || (!indirect && path.specularBounces == 0);
  if (!path.rough) return out;
  const Bsdf bsdf(accel.scene(), path.hit);
  describeShadingPoint(bsdf, out);
  if (directOnly && shown == ShownLight::Indirect) return out;
  leaving(bsdf, path.throughput, directOnly, out);
  return out;
}

}  // namespace bnvpl
