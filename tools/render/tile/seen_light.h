// Light that the camera sees without a surface between that scatters it: lamps, the sky in a
// window, and both in mirrors. Its borders are sharp, and what is seen beside them is much darker:
// there the noise of a pixel is that of where its camera rays go, which are cheap.
#pragma once

#include "tools/render/tile/pixel_rays.h"

namespace bnvpl {

class SeenLight {
 public:
  // Borrows rays and lights.
  SeenLight(const RayScene& rays, const LightSet& lights, const FilmPoints& film)
      : pixels_(rays, lights, film, film.seen, 0.0, kDrawRays) {}

  // `sum`: direct and seen light of `count` rays of a sample. Becomes their mean with what the
  // pixel's further rays see. The film's points alone, not the sample, say how many these are: the
  // mean stays unbiased.
  void withMoreRays(RadianceSample& sum, unsigned count, const TileSlots& tile, uint32_t pixel,
                    uint32_t slot, const LightsBehind& behind) const {
    pixels_.forEach(tile, pixel, slot, behind, [&](const SpecularPath&, const RadianceSample& s) {
      sum.direct += s.direct, sum.seen += s.seen;
    });
    const float each = 1.0f / static_cast<float>(count + pixels_.count(tile, pixel));
    sum.direct *= each, sum.seen *= each;
  }

 private:
  static constexpr uint32_t kDrawRays = 1u << 31;
  PixelRays pixels_;
};

}  // namespace bnvpl
