#include "tools/render/tile/control/pixel_rays.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/winsorized_mean.h"

namespace bnvpl {

namespace {

// Rays for a pixel around which the deviation equals the mean of the film, and the bounds where the
// quantity varies. A ray takes about a hundredth of the time of a sample.
constexpr double kRays = 8, kMinRays = 2, kMaxRays = 32;

}  // namespace

PixelRays::PixelRays(const Accelerator& accel, const LightSet& lights, const PixelFilter& filter,
                     const FilmPoints& filmPoints, std::span<const float> values,
                     double minDeviation, TileDimension dimension)
    : accel_(accel),
      lights_(lights),
      filter_(filter),
      width_(filmPoints.width),
      dimension_(dimension),
      raysEach_(values.size()) {
  const double filmMean = winsorizedMean({values.begin(), values.end()});
  parallelFor(raysEach_.size(), 1024, [&](size_t i) {
    const size_t x = i % filmPoints.width, y = i / filmPoints.width;
    double sum = 0.0, squares = 0.0, count = 0.0;
    for (size_t v = y > 0 ? y - 1 : 0; v < std::min<size_t>(filmPoints.height, y + 2); ++v) {
      for (size_t u = x > 0 ? x - 1 : 0; u < std::min<size_t>(filmPoints.width, x + 2); ++u) {
        const double value = double{values[v * filmPoints.width + u]};
        if (!std::isfinite(value)) continue;
        sum += value, squares += value * value, count += 1.0;
      }
    }
    const double mean = sum / count, variance = squares / count - mean * mean;
    if (!(variance > 1e-6 * filmMean * filmMean &&
          variance > minDeviation * minDeviation * mean * mean)) {
      return;
    }
    raysEach_[i] = static_cast<uint8_t>(
        std::clamp(kRays * std::sqrt(variance) / filmMean, kMinRays, kMaxRays));
  });
}

}  // namespace bnvpl
