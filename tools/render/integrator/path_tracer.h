#pragma once

#include "tools/render/integrator/integrator_method.h"
#include "tools/render/stage_options.h"

namespace bnvpl {

// The option of every integrator that traces paths.
inline constexpr WholeOption kMaxBouncesOption =
    neededBy({kIndirectIsShown},
             wholeOption("max-bounces", "32", 0, 1000, "",
                         "bounces off rough surfaces after the first, as vpl-estimate's"));
inline unsigned maxBouncesOf(const Values& options) {  // none counts for direct light
  return options.has(kMaxBouncesOption) ? static_cast<unsigned>(options[kMaxBouncesOption]) : 0;
}

// The reference: unbiased path tracing with next-event estimation and multiple importance sampling,
// without clamping. Rough scatterings after the first rough vertex are limited to maxBounces, like
// those of photons.
class PathTracer {
 public:
  // `indirect`: whether to add indirect light at points that the camera sees directly. If not, the
  // LightTracer does.
  PathTracer(const Accelerator& accel, const LightSet& lights, unsigned maxBounces,
             ShownLight shown, bool indirect = true)
      : accel_(accel),
        lights_(lights),
        maxBounces_(maxBounces),
        shown_(shown),
        indirect_(indirect) {}
  void render(const TileSamples& tile) const;

 private:
  RadianceSample trace(const CameraSample& sample, Rng& rng) const;

  const Accelerator& accel_;
  const LightSet& lights_;
  unsigned maxBounces_;
  ShownLight shown_;
  bool indirect_;
};

}  // namespace bnvpl
