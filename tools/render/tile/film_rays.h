// One camera ray for each pixel of the film: the surface points that the film shows.
#pragma once

#include "core/parallel.h"
#include "core/random_streams.h"
#include "tools/render/camera_path.h"
#include "tools/render/gather/gather.h"

namespace bnvpl {

class FilmRays {
 public:
  // `spatialLights` may be null. Borrows all but the filter.
  FilmRays(const Accelerator& accel, const LightSet& lights, const PixelFilter& filter,
           const SpatialLightSampler* spatialLights, uint64_t seed)
      : accel_(accel),
        lights_(lights),
        filter_(filter),
        spatialLights_(spatialLights),
        key_(streamKey(seed, RandomStream::FilmPoints)) {}

  // The shading point; its triangle is kNone if there is none. `direct` receives the direct
  // light that the camera path collects before it, mean of the channels.
  SurfacePoint point(size_t pixel, float* direct = nullptr) const {
    const uint32_t width = accel_.scene().film.width;
    Rng rng(key_, pixel);
    const float x = rng.next(), y = rng.next();
    RadianceSample sample;
    SpecularPath path = traceCameraPath(
        accel_, lights_, static_cast<uint32_t>(pixel % width), static_cast<uint32_t>(pixel / width),
        {filter_.sample({x, y}).at}, rng, sample, {nullptr, spatialLights_});
    if (!path.rough) path.hit.triangle = kNone;
    if (direct) *direct = mean(sample.direct);
    return path.hit;
  }

  FilmPoints all() const {
    const Film& size = accel_.scene().film;
    FilmPoints found{size.width, size.height, {}, {}};
    found.points.resize(size_t{found.width} * found.height);
    found.direct.resize(found.points.size());
    parallelFor(found.points.size(), 64,
                [&](size_t i) { found.points[i] = point(i, &found.direct[i]); });
    return found;
  }

 private:
  const Accelerator& accel_;
  const LightSet& lights_;
  PixelFilter filter_;
  const SpatialLightSampler* spatialLights_;
  uint64_t key_;
};

}  // namespace bnvpl
