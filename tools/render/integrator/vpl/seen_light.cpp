#include "tools/render/integrator/vpl/seen_light.h"

#include <algorithm>

#include "core/parallel.h"
#include "tools/render/integrator/camera_vertex.h"
#include "transport/camera.h"

namespace bnvpl {

namespace {

constexpr unsigned kMoreRays = 8;
constexpr uint32_t kDrawRays = 1u << 31;  // dimension of a tile's random numbers

}  // namespace

SeenLight::SeenLight(const RayScene& rays, const LightSet& lights, const FilmPoints& film)
    : rays_(rays), lights_(lights), width_(film.width), varies_(film.points.size()) {
  parallelFor(varies_.size(), 1024, [&](size_t i) {
    const size_t x = i % film.width, y = i / film.width;
    for (size_t v = y > 0 ? y - 1 : 0; v < std::min<size_t>(film.height, y + 2); ++v) {
      for (size_t u = x > 0 ? x - 1 : 0; u < std::min<size_t>(film.width, x + 2); ++u)
        if (film.seen[v * film.width + u] != film.seen[i]) varies_[i] = 1;
    }
  });
}

Vec3 SeenLight::withMoreRays(Vec3 seen, const TileSlots& tile, uint32_t pixel,
                             uint32_t slot) const {
  const uint32_t x = tile.x + pixel % tile.width, y = tile.y + pixel / tile.width;
  if (varies_[size_t{y} * width_ + x] == 0) return seen;
  const Scene& scene = rays_.scene();
  const uint64_t key = random64(tile.key, pixel, kDrawRays);
  for (unsigned k = 0; k < kMoreRays; ++k) {
    const uint64_t index = uint64_t{slot} * kMoreRays + k;
    const Point2 at = owenSobol(static_cast<uint32_t>(index), key);
    Rng rng(key, index);
    RadianceSample more;
    seeFrom(rays_, lights_, scene.camera.position,
            cameraDirection(scene.camera, scene.film, (float(x) + at.x) / float(scene.film.width),
                            (float(y) + at.y) / float(scene.film.height)),
            rng, more);
    seen += more.direct;
  }
  return seen * (1.0f / (1 + kMoreRays));
}

}  // namespace bnvpl
