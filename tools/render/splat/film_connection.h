// Connection of a vertex with the film: the pixels that show it, and the vertex's contribution.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "tools/render/pixel_filter.h"
#include "tools/render/splat/splat.h"
#include "transport/accelerator/accelerator.h"

namespace bnvpl {

struct FilmConnection {
  Point2 at;      // place on the film, in pixels
  float perArea;  // density, per unit of area, of a camera ray of a pixel's box at the vertex
  Vec3 value;     // BSDF of the rough lobes, 1/sr
};

// Connects a vertex where a photon arrived from direction vertex.wo with a point of the lens, which
// is relative to the camera's position and uniform on the lens (sampleLens()). Returns nothing if
// it is not seen directly from there, the BSDF is 0, or no pixel's filter covers its place. A
// photon of flux F adds F * value * perArea to the radiance of the pixels, times their filters'
// values.
std::optional<FilmConnection> connectToFilm(const Accelerator& accel, const SurfacePoint& vertex,
                                            Vec3 lens, const PixelFilter& filter);

// Calls fn(pixel, value) for the pixels whose filter is not 0 at a place on the film.
template <typename Fn>
void forPixelsAt(const Film& film, const PixelFilter& filter, Point2 at, const Fn& fn) {
  if (filter.isPixel()) {
    const auto x = std::min(film.width - 1, static_cast<uint32_t>(at.x)),
               y = std::min(film.height - 1, static_cast<uint32_t>(at.y));
    fn(y * film.width + x, 1.0f);
    return;
  }
  // Pixels whose centres lie within the radius.
  const auto first = [&](float from) {
    return static_cast<uint32_t>(std::max(0.0f, std::ceil(from - filter.radius() - 0.5f)));
  };
  const auto end = [&](float to, uint32_t count) {
    const float last = std::floor(to + filter.radius() - 0.5f);
    return last < 0.0f ? 0u : std::min(count, static_cast<uint32_t>(last) + 1);
  };
  for (uint32_t y = first(at.y); y < end(at.y, film.height); ++y) {
    for (uint32_t x = first(at.x); x < end(at.x, film.width); ++x) {
      const float value =
          filter.density(at.x - static_cast<float>(x) - 0.5f, at.y - static_cast<float>(y) - 0.5f);
      if (value != 0.0f) fn(y * film.width + x, value);
    }
  }
}
// perArea of a vertex that is seen from `origin`, a point of the lens; `seen.wo` points there.
float samplesPerArea(const Scene& scene, const SurfacePoint& seen, Vec3 origin);

}  // namespace bnvpl
