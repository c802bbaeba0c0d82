// Paths for indirect light whose directions are sampled from a Guide, learned from the lit VPLs.
// The VPLs' flux itself adds no light to the image.
#pragma once

#include "tools/render/integrator/guided/guide.h"
#include "tools/render/tile/indirect_rays.h"
#include "transport/direct_light/spatial_light_sampler.h"
#include "transport/specular_path.h"

namespace bnvpl {

class GuidedRays : public IndirectRays {
 public:
  // `spatialLights`: distribution for light sampling at vertices. `guideShare`: share of directions
  // that are sampled from the guide in regions that it knows; below 1. `maxBounces`: limit of
  // bounces after the shading point.
  GuidedRays(const Accelerator& accel, const LightSet& lights, Guide guide,
             const SpatialLightSampler& spatialLights, float guideShare, unsigned maxBounces,
             ShownLight shown)
      : accel_(accel),
        lights_(lights),
        guide_(std::move(guide)),
        spatialLights_(spatialLights),
        guideShare_(guideShare),
        maxBounces_(maxBounces),
        shown_(shown) {}

  Directions directionsFrom(const Bsdf& bsdf) const override {
    return directionsIn(guide_.regionAt(bsdf.point()), bsdf);
  }
  void send(const RayOrigin& from, unsigned count, uint32_t first, uint64_t key,
            RayContributions& out) const override;
  double costOfRay() const override;

 private:
  Directions directionsIn(uint32_t region, const Bsdf& bsdf) const {
    return guide_.knows(region) ? Directions(bsdf, guide_, region, guideShare_) : Directions(bsdf);
  }
  // `expected`: radiance that leaves the shading point, as the guide knows it, times the throughput
  // to the camera, mean of the channels; 0: unknown.
  // `groups`: room for three colours of each light group.
  void follow(const FirstSegment& start, float expected, bool reuse, std::span<Vec3> groups,
              RayContributions& out) const;
  LightWithPart tracePath(const Bsdf& first, const FirstSegment& start, float expected,
                          Vec3 throughput, Vec3 diffuse, Rng& rng, std::span<Vec3> groups) const;

  const Accelerator& accel_;
  const LightSet& lights_;
  Guide guide_;
  const SpatialLightSampler& spatialLights_;
  float guideShare_;
  unsigned maxBounces_;
  ShownLight shown_;
};

}  // namespace bnvpl
