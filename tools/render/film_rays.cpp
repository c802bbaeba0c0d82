#include "tools/render/film_rays.h"

#include "core/parallel.h"
#include "core/random_streams.h"
#include "tools/render/camera_path.h"

namespace bnvpl {

FilmRays::FilmRays(const Accelerator& accel, const LightSet& lights, const PixelFilter& filter,
                   const SpatialLightSampler* spatialLights, uint64_t seed)
    : accel_(accel),
      lights_(lights),
      filter_(filter),
      spatialLights_(spatialLights),
      key_(streamKey(seed, RandomStream::FilmPoints)) {}

SurfacePoint FilmRays::point(size_t pixel, float* direct) const {
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

FilmPoints FilmRays::all() const {
  const Film& size = accel_.scene().film;
  FilmPoints found{size.width, size.height, {}, {}};
  found.points.resize(size_t{found.width} * found.height);
  found.direct.resize(found.points.size());
  parallelFor(found.points.size(), 64,
              [&](size_t i) { found.points[i] = point(i, &found.direct[i]); });
  return found;
}

}  // namespace bnvpl
