// Further camera rays of a pixel, for what is cheap to see along them and varies between pixels:
// its noise is that of where the rays go.
#pragma once

#include <span>
#include <vector>

#include "core/random.h"
#include "core/sampling.h"
#include "tools/render/gather/gather.h"
#include "tools/render/integrator/camera_vertex.h"
#include "tools/render/tile.h"
#include "transport/camera.h"

namespace bnvpl {

class PixelRays {
 public:
  // `values`: what a ray saw at each of the film's points. The more it varies around a pixel, the
  // more rays this gets for each of its samples; none where it deviates by less than `least` times
  // its mean there. `draw`: dimension of a tile's random numbers.
  // Borrows rays and lights.
  PixelRays(const RayScene& rays, const LightSet& lights, const FilmPoints& film,
            std::span<const float> values, double least, uint32_t draw);

  // Of one sample.
  unsigned count(const TileSlots& tile, uint32_t pixel) const {
    return more_[size_t{tile.y + pixel / tile.width} * width_ + tile.x + pixel % tile.width];
  }
  // Calls fn(path, sample) for each of them. What they see is independent of the sample.
  template <typename Fn>
  void forEach(const TileSlots& tile, uint32_t pixel, uint32_t slot, const LightsBehind& behind,
               const Fn& fn) const {
    const uint32_t x = tile.x + pixel % tile.width, y = tile.y + pixel / tile.width;
    const unsigned more = count(tile, pixel);
    const Scene& scene = rays_.scene();
    const uint64_t key = random64(tile.key, pixel, draw_);
    for (unsigned k = 0; k < more; ++k) {
      const uint64_t index = uint64_t{slot} * more + k;
      Rng rng = Rng::spread(key, static_cast<uint32_t>(index));
      const Point2 at = rng.nextPoint();
      RadianceSample sample;
      const SpecularPath path = seeFrom(
          rays_, lights_, scene.camera.position,
          cameraDirection(scene.camera, scene.film, (float(x) + at.x) / float(scene.film.width),
                          (float(y) + at.y) / float(scene.film.height)),
          rng, sample, behind);
      fn(path, sample);
    }
  }

 private:
  const RayScene& rays_;
  const LightSet& lights_;
  uint32_t width_, draw_;
  std::vector<uint8_t> more_;  // rays of each pixel, for each sample
};

}  // namespace bnvpl
