// One camera ray for each pixel of the film: the surface points that the film shows.
#pragma once

#include <cstddef>

#include "tools/render/film_points.h"
#include "tools/render/pixel_filter.h"
#include "transport/direct_light/spatial_light_sampler.h"
#include "transport/lights/lights.h"

namespace bnvpl {

class FilmRays {
 public:
  // `spatialLights` may be null. Borrows all but the filter.
  FilmRays(const Accelerator& accel, const LightSet& lights, const PixelFilter& filter,
           const SpatialLightSampler* spatialLights, uint64_t seed);

  // The shading point; its triangle is kNone if there is none. `direct` receives the direct
  // light that the camera path collects before it, mean of the channels.
  SurfacePoint point(size_t pixel, float* direct = nullptr) const;
  FilmPoints all() const;

 private:
  const Accelerator& accel_;
  const LightSet& lights_;
  PixelFilter filter_;
  const SpatialLightSampler* spatialLights_;
  uint64_t key_;
};

}  // namespace bnvpl
