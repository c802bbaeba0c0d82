#include "tools/render/integrator/vpl/seen_light.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "tools/render/integrator/camera_vertex.h"
#include "transport/camera.h"

namespace bnvpl {

namespace {

// Of a pixel around which the light seen deviates by as much as its mean over the image, and of any
// where it varies. A ray takes a hundredth of the time of a sample.
constexpr double kMoreRays = 8, kFewest = 2, kMost = 32;
constexpr uint32_t kDrawRays = 1u << 31;  // dimension of a tile's random numbers

}  // namespace

SeenLight::SeenLight(const RayScene& rays, const LightSet& lights, const FilmPoints& film)
    : rays_(rays), lights_(lights), width_(film.width), more_(film.points.size()) {
  const double all = parallelSum(more_.size(), [&](size_t i) { return double{film.seen[i]}; }) /
                     static_cast<double>(more_.size());
  parallelFor(more_.size(), 1024, [&](size_t i) {
    const size_t x = i % film.width, y = i / film.width;
    double sum = 0.0, squares = 0.0, count = 0.0;
    for (size_t v = y > 0 ? y - 1 : 0; v < std::min<size_t>(film.height, y + 2); ++v) {
      for (size_t u = x > 0 ? x - 1 : 0; u < std::min<size_t>(film.width, x + 2); ++u) {
        const double seen = double{film.seen[v * film.width + u]};
        sum += seen, squares += seen * seen, count += 1.0;
      }
    }
    const double variance = squares / count - sum * sum / (count * count);
    if (!(variance > 1e-6 * all * all)) return;
    more_[i] =
        static_cast<uint8_t>(std::clamp(kMoreRays * std::sqrt(variance) / all, kFewest, kMost));
  });
}

Vec3 SeenLight::withMoreRays(Vec3 seen, unsigned count, const TileSlots& tile, uint32_t pixel,
                             uint32_t slot) const {
  const uint32_t x = tile.x + pixel % tile.width, y = tile.y + pixel / tile.width;
  const unsigned more = more_[size_t{y} * width_ + x];
  const Scene& scene = rays_.scene();
  const uint64_t key = random64(tile.key, pixel, kDrawRays);
  for (unsigned k = 0; k < more; ++k) {
    const uint64_t index = uint64_t{slot} * more + k;
    const Point2 at = owenSobol(static_cast<uint32_t>(index), key);
    Rng rng(key, index);
    RadianceSample sample;
    seeFrom(rays_, lights_, scene.camera.position,
            cameraDirection(scene.camera, scene.film, (float(x) + at.x) / float(scene.film.width),
                            (float(y) + at.y) / float(scene.film.height)),
            rng, sample);
    seen += sample.direct;
  }
  return seen * (1.0f / static_cast<float>(count + more));
}

}  // namespace bnvpl
