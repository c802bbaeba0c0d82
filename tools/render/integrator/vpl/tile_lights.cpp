#include "tools/render/integrator/vpl/tile_lights.h"

#include <algorithm>

#include "core/parallel.h"
#include "tools/common/streams.h"

namespace bnvpl {

namespace {

constexpr size_t kMostProbes = 16;  // of a stratum: those of the tiles around add to them

}  // namespace

TileLights::TileLights(const RayScene& rays, const LightSet& lights, const FilmPoints& film,
                       uint64_t raysOfTile, uint64_t seed, const ProgressFn& progress)
    : rays_(rays),
      lights_(lights),
      strata_(lights),
      probes_(std::clamp<uint64_t>(raysOfTile / 2 / std::max<size_t>(1, strata_.size()), 1,
                                   kMostProbes)),
      tilesX_((film.width + kTileSide - 1) / kTileSide),
      tilesY_((film.height + kTileSide - 1) / kTileSide),
      tiles_(tilesX_ * tilesY_) {
  if (strata_.size() < 2) return;
  const auto phase = progress.before("visible lights", tiles_.size());
  std::vector<StrataValues> found(tiles_.size());
  parallelFor(tiles_.size(), 1, [&](size_t tile) {
    found[tile] = probe(film, tile, streamKey(seed, Stream::TileLights));
    if (progress) progress(1);
  });
  parallelFor(tiles_.size(), 16, [&](size_t tile) { tiles_[tile] = pooled(found, tile); });
  everywhere_ = meanOf(tiles_, strata_.size());
}

StrataValues TileLights::probe(const FilmPoints& film, size_t tile, uint64_t key) const {
  const auto x0 = static_cast<uint32_t>(tile % tilesX_) * kTileSide,
             y0 = static_cast<uint32_t>(tile / tilesX_) * kTileSide;
  std::vector<Bsdf> seen;
  seen.reserve(size_t{kTileSide} * kTileSide);
  for (uint32_t y = y0; y < std::min(film.height, y0 + kTileSide); ++y) {
    for (uint32_t x = x0; x < std::min(film.width, x0 + kTileSide); ++x) {
      const SurfacePoint& p = film.points[size_t{y} * film.width + x];
      if (p.triangle != kNone) seen.emplace_back(rays_.scene(), p);
    }
  }
  Rng rng(key, tile);
  return probeStrata(rays_, lights_, strata_, seen, probes_, rng);
}

// By the probes of the tile and those around it.
StrataValues TileLights::pooled(std::span<const StrataValues> found, size_t tile) const {
  const size_t x = tile % tilesX_, y = tile / tilesX_;
  PooledProbes sum(strata_.size());
  for (size_t j = y > 0 ? y - 1 : 0; j < std::min(tilesY_, y + 2); ++j) {
    for (size_t i = x > 0 ? x - 1 : 0; i < std::min(tilesX_, x + 2); ++i)
      sum.add(found[j * tilesX_ + i]);
  }
  return sum.distribution();
}

LearnedStrata TileLights::at(uint32_t x, uint32_t y) const {
  return {&strata_, tiles_[y / kTileSide * tilesX_ + x / kTileSide].seen(), everywhere_.seen()};
}

}  // namespace bnvpl
