#include "tools/render/film/filter/gather_filter.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace bnvpl {

namespace {

// Ratio of two sums over samples, by channels; NaN where the denominator is 0.
Vec3 ratio(const PixelSums& p, size_t above, size_t below) {
  Vec3 out(NAN);
  for (int c = 0; c < 3; ++c) {
    const double by = p.sum[below + size_t(c)];
    if (by > 0.0) out[c] = static_cast<float>(p.sum[above + size_t(c)] / by);
  }
  return out;
}

PixelSurface surfaceOf(const PixelSums& p) {
  const double hits = p.sum[PixelSums::kHits];
  if (!(hits > 0.0)) return {};
  const double* n = &p.sum[PixelSums::kNormal];
  const Vec3 normal(float(n[0] / hits), float(n[1] / hits), float(n[2] / hits));
  return {ratio(p, PixelSums::kToFilter, PixelSums::kAlbedo),
          length(normal) > 0.0f ? normalize(normal) : Vec3{},
          static_cast<float>(p.sum[PixelSums::kDepth] / hits)};
}

}  // namespace

PixelBox GatherFilter::needed(const PixelBox& box, uint32_t width, uint32_t height) const {
  const int reach = static_cast<int>(halo);
  return {std::max(0, box.x0 - reach), std::max(0, box.y0 - reach),
          std::min(static_cast<int>(width), box.x1 + reach),
          std::min(static_cast<int>(height), box.y1 + reach)};
}

void applyFilter(const GatherFilter& filter, uint32_t width, const PixelBox& box,
                 const std::function<uint64_t(size_t)>& samples, std::span<PixelSums> film,
                 std::span<PixelCounts> counts) {
  FilmSurfaces seen{width, static_cast<uint32_t>(film.size() / width), {}};
  seen.pixels.resize(film.size());
  parallelFor(film.size(), 1024, [&](size_t i) { seen.pixels[i] = surfaceOf(film[i]); });
  const auto across = static_cast<size_t>(box.x1 - box.x0);
  const size_t count = across * static_cast<size_t>(box.y1 - box.y0);
  parallelFor(count, 256, [&](size_t k) {
    const auto x = static_cast<uint32_t>(box.x0) + static_cast<uint32_t>(k % across);
    const auto y = static_cast<uint32_t>(box.y0) + static_cast<uint32_t>(k / across);
    const FilteredLight filtered = filter.light(seen, x, y);
    const size_t i = size_t{y} * width + x;
    PixelSums& p = film[i];
    counts[i].own[0] = filtered.pixels * samples(i);
    for (size_t c = 0; c < 3; ++c) {
      const double albedo = p.sum[PixelSums::kAlbedo + c];
      const double after = albedo > 0.0 ? double{filtered.light[int(c)]} * albedo : 0.0;
      double& before = p.sum[PixelSums::kToFilter + c];
      p.sum[PixelSums::kIndirect + c] += after - before;
      before = after;
    }
  });
}

}  // namespace bnvpl
