// Emitters that camera rays hit, at once or over mirrors, glass and near-specular lobes. Their
// edges are sharp and bright. Camera rays are cheap, so pixels at such edges get more of them.
#pragma once

#include "tools/render/tile/control/pixel_rays.h"

namespace bnvpl {

class VisibleEmission {
 public:
  // Borrows accel and lights.
  VisibleEmission(const Accelerator& accel, const LightSet& lights, const PixelFilter& filter,
                  const FilmPoints& filmPoints)
      : pixels_(accel, lights, filter, filmPoints, filmPoints.direct, 0.0, kDimEmissionRays) {}

  // `sum`: direct light and emission of `count` camera rays of a sample. Replaces both by the mean
  // over these and the pixel's further rays. The number of further rays depends on the film's
  // points, not on the sample, so that the mean is unbiased. `groups`: both by light group.
  void average(RadianceSample& sum, unsigned count, const TileLayout& tile, uint32_t pixel,
               uint32_t sample, const SpecularLightSampling& specularLights,
               const SampleGroups& groups = {}) const {
    pixels_.forEach(
        tile, pixel, sample, specularLights,
        [&](const SpecularPath&, const RadianceSample& s, float) {
          sum.direct += s.direct, sum.emission += s.emission;
        },
        groups);
    const float each = 1.0f / static_cast<float>(count + pixels_.count(tile, pixel));
    sum.direct *= each, sum.emission *= each;
    groups.scaleDirect(each);
  }

 private:
  PixelRays pixels_;
};

}  // namespace bnvpl
