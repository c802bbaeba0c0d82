#include "tools/render/tile/pixel_rays.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace bnvpl {

namespace {

// Of a pixel around which the values deviate by as much as their mean over the image, and of any
// where they vary. A ray takes a hundredth of the time of a sample.
constexpr double kMoreRays = 8, kFewest = 2, kMost = 32;

}  // namespace

PixelRays::PixelRays(const RayScene& rays, const LightSet& lights, const FilmPoints& film,
                     std::span<const float> values, double least, uint32_t draw)
    : rays_(rays), lights_(lights), width_(film.width), draw_(draw), more_(values.size()) {
  const double all = parallelSum(more_.size(), [&](size_t i) { return double{values[i]}; }) /
                     static_cast<double>(more_.size());
  parallelFor(more_.size(), 1024, [&](size_t i) {
    const size_t x = i % film.width, y = i / film.width;
    double sum = 0.0, squares = 0.0, count = 0.0;
    for (size_t v = y > 0 ? y - 1 : 0; v < std::min<size_t>(film.height, y + 2); ++v) {
      for (size_t u = x > 0 ? x - 1 : 0; u < std::min<size_t>(film.width, x + 2); ++u) {
        const double seen = double{values[v * film.width + u]};
        sum += seen, squares += seen * seen, count += 1.0;
      }
    }
    const double mean = sum / count, variance = squares / count - mean * mean;
    if (!(variance > 1e-6 * all * all && variance > least * least * mean * mean)) return;
    more_[i] =
        static_cast<uint8_t>(std::clamp(kMoreRays * std::sqrt(variance) / all, kFewest, kMost));
  });
}

}  // namespace bnvpl
