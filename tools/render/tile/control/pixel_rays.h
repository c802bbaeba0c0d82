// Further camera rays of a pixel, for quantities that are cheap to find along a ray and vary within
// the pixel.
#pragma once

#include <span>
#include <vector>

#include "core/random.h"
#include "core/sampling.h"
#include "tools/render/camera_path.h"
#include "tools/render/film_points.h"
#include "tools/render/sample.h"
#include "tools/render/tile_dimensions.h"

namespace bnvpl {

class PixelRays {
 public:
  // `values`: the quantity along one ray of each pixel. The more it varies around a pixel, the more
  // rays each of the pixel's samples gets; none where its deviation is below `minDeviation` times
  // its mean. Borrows accel and lights.
  PixelRays(const Accelerator& accel, const LightSet& lights, const PixelFilter& filter,
            const FilmPoints& filmPoints, std::span<const float> values, double minDeviation,
            TileDimension dimension);

  // Rays for each sample of a pixel of the tile.
  unsigned count(const TileLayout& tile, uint32_t pixel) const {
    return raysEach_[size_t{tile.pixelY(pixel)} * width_ + tile.pixelX(pixel)];
  }
  // Calls fn(path, sample, weight) for each ray; path and sample include the weight, which is that
  // of the filter. The rays are independent of the sample. `groups` receives their emission.
  template <typename Fn>
  void forEach(const TileLayout& tile, uint32_t pixel, uint32_t sampleIndex,
               const SpecularLightSampling& specularLights, const Fn& fn,
               const SampleGroups& groups = {}) const {
    const uint32_t x = tile.pixelX(pixel), y = tile.pixelY(pixel);
    const unsigned rays = count(tile, pixel);
    const uint64_t key = random64(tile.key, pixel, dimension_);
    for (unsigned k = 0; k < rays; ++k) {
      const uint64_t index = uint64_t{sampleIndex} * rays + k;
      Rng rng = Rng::stratified(key, static_cast<uint32_t>(index));
      const PixelFilter::Sample at = filter_.sample(
          rng.nextPoint(), {index, uint64_t{tile.samplesPerPixel} * rays, key, tile.weighted});
      RadianceSample sample;
      const SpecularPath path =
          traceCameraPath(accel_, lights_, x, y, at, rng, sample, specularLights, groups);
      fn(path, sample, at.weight);
    }
  }

 private:
  const Accelerator& accel_;
  const LightSet& lights_;
  PixelFilter filter_;
  uint32_t width_;
  TileDimension dimension_;
  std::vector<uint8_t> raysEach_;  // for each pixel
};

}  // namespace bnvpl
