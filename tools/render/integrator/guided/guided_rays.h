// Rays that find out the light of what they hit by path tracing, whose directions a Guide takes
// part in choosing. No VPL's flux is light in the image.
#pragma once

#include "tools/render/integrator/guided/guide.h"
#include "tools/render/tile/indirect_rays.h"
#include "transport/specular_path.h"
#include "transport/surface_lights.h"

namespace bnvpl {

class GuidedRays : public IndirectRays {
 public:
  // `share`: of the directions that the guide chooses, where it knows the region; below 1.
  // `where`: where light sampling looks for lights. `maxBounces`: of paths, after the vertex that
  // rays start from. `raysEach`: from a vertex, for which light is shared with photons.
  GuidedRays(const RayScene& rays, const LightSet& lights, Guide guide, const SurfaceLights& where,
             float share, unsigned raysEach, unsigned maxBounces, Only only)
      : rays_(rays),
        lights_(lights),
        guide_(std::move(guide)),
        where_(where),
        share_(share),
        raysEach_(raysEach),
        maxBounces_(maxBounces),
        only_(only) {}

  Directions directionsFrom(const Bsdf& bsdf) const override {
    return directionsIn(guide_.regionAt(bsdf.point()), bsdf);
  }
  void send(const RaysFrom& from, unsigned count, uint32_t first, uint64_t key,
            RaysBrought& out) const override;
  double costOfRay() const override;

 private:
  Directions directionsIn(uint32_t region, const Bsdf& bsdf) const {
    return guide_.knows(region) ? Directions(bsdf, guide_, region, share_) : Directions(bsdf);
  }
  // `shown`: radiance that leaves the ray's origin by the guide, mean of the channels; 0: not
  // known.
  void follow(const FirstLink& start, float shown, bool share, RaysBrought& out) const;
  LightWithPart lightFrom(const Bsdf& first, const FirstLink& start, float shown, Vec3 throughput,
                          Vec3 matt, Rng& rng) const;

  const RayScene& rays_;
  const LightSet& lights_;
  Guide guide_;
  const SurfaceLights& where_;
  float share_;
  unsigned raysEach_, maxBounces_;
  Only only_;
};

}  // namespace bnvpl
