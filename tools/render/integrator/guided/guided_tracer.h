// Path tracing whose directions a Guide takes part in choosing.
#pragma once

#include "tools/render/integrator/guided/guide.h"
#include "tools/render/integrator/integrator.h"
#include "transport/bsdf.h"
#include "transport/leaving_light.h"
#include "transport/surface_lights.h"

namespace bnvpl {

class GuidedTracer {
 public:
  // `share`: of the directions that the guide chooses, where it knows the region; below 1.
  // `where`: where light sampling looks for lights.
  GuidedTracer(const RayScene& rays, const LightSet& lights, Guide guide, SurfaceLights where,
               float share, unsigned maxBounces, Only only)
      : rays_(rays),
        lights_(lights),
        guide_(std::move(guide)),
        where_(std::move(where)),
        share_(share),
        maxBounces_(maxBounces),
        only_(only) {}
  void render(const TileSamples& tile) const;

 private:
  void addLeaving(const Bsdf& at, Vec3 throughput, PathLength length, Rng& rng, Vec3& first,
                  Vec3& later) const;

  const RayScene& rays_;
  const LightSet& lights_;
  Guide guide_;
  SurfaceLights where_;
  float share_;
  unsigned maxBounces_;
  Only only_;
};

}  // namespace bnvpl
