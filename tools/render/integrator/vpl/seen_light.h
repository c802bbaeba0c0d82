// Light that the camera sees without a surface between that scatters it: lamps, the sky in a
// window, and both in mirrors. Its borders are sharp, and what is seen beside them is much darker:
// there the noise of a pixel is that of where its camera rays go, which are cheap.
#pragma once

#include <vector>

#include "core/random.h"
#include "tools/render/gather/gather.h"
#include "tools/render/tile.h"
#include "transport/lights.h"

namespace bnvpl {

class SeenLight {
 public:
  // The more the light seen varies around a pixel, the more rays it gets. Borrows rays and lights.
  SeenLight(const RayScene& rays, const LightSet& lights, const FilmPoints& film);

  // The mean of what `count` rays of a sample saw, whose sum is `seen`, and of what the pixel's
  // further rays see.
  // The film's points alone, not the sample, say how many these are: the mean stays unbiased.
  Vec3 withMoreRays(Vec3 seen, unsigned count, const TileSlots& tile, uint32_t pixel,
                    uint32_t slot) const;

 private:
  const RayScene& rays_;
  const LightSet& lights_;
  uint32_t width_;
  std::vector<uint8_t> more_;  // rays of each pixel, for each sample
};

}  // namespace bnvpl
