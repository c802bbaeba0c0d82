#include "tools/render/integrator/vpl/tile_lights.h"

#include <algorithm>
#include <cmath>

#include "core/cdf.h"
#include "core/parallel.h"
#include "tools/common/streams.h"

namespace bnvpl {

namespace {

constexpr size_t kMostProbes = 16;  // of a stratum: those of the tiles around add to them
// Strata that would get less than this share of an even one are left to what all get.
constexpr float kLeast = 0.1f;

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
  std::vector<Found> found(tiles_.size());
  parallelFor(tiles_.size(), 1, [&](size_t tile) {
    found[tile] = probe(film, tile, streamKey(seed, Stream::TileLights));
    if (progress) progress(1);
  });
  parallelFor(tiles_.size(), 16,
              [&](size_t tile) { tiles_[tile] = distribution(pooled(found, tile)); });
  std::vector<float> sum(strata_.size());
  for (const Found& t : tiles_)
    for (size_t k = 0; k < t.strata.size(); ++k) sum[t.strata[k]] += cdfShare<float>(t.values, k);
  everywhere_ = distribution(sum);
}

TileLights::Found TileLights::probe(const FilmPoints& film, size_t tile, uint64_t key) const {
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
  Found out;
  if (seen.empty()) return out;
  Rng rng(key, tile);
  for (uint32_t s = 0; s < strata_.size(); ++s) {
    float sum = 0.0f;
    for (size_t k = 0; k < probes_; ++k) {
      const auto which = static_cast<size_t>(rng.next() * static_cast<float>(seen.size()));
      const Bsdf& bsdf = seen[std::min(which, seen.size() - 1)];
      const float u = rng.next(), v = rng.next();
      const LightPlace place = strata_.place(s, {u, v});
      DirectSample sample;
      Vec3 reflected;
      if (!unoccludedLight(lights_, bsdf, LobeGroup::Rough, place, sample, reflected) ||
          isHidden(rays_, bsdf.point(), sample))
        continue;
      const float brought = mean(reflected) * strata_.share(s) / strata_.lightShare(place.light);
      sum += brought * brought;
    }
    if (!(sum > 0.0f) || !std::isfinite(sum)) continue;
    out.strata.push_back(s);
    out.values.push_back(sum / static_cast<float>(probes_));
  }
  return out;
}

// What each stratum should get, but for a factor, by the probes of the tile and those around it.
// The variance of a sum of estimates is least where each is drawn in proportion to the root of its
// mean square.
std::vector<float> TileLights::pooled(const std::vector<Found>& found, size_t tile) const {
  const size_t x = tile % tilesX_, y = tile / tilesX_;
  std::vector<float> values(strata_.size());
  for (size_t j = y > 0 ? y - 1 : 0; j < std::min(tilesY_, y + 2); ++j) {
    for (size_t i = x > 0 ? x - 1 : 0; i < std::min(tilesX_, x + 2); ++i) {
      const Found& f = found[j * tilesX_ + i];
      for (size_t k = 0; k < f.strata.size(); ++k) values[f.strata[k]] += f.values[k];
    }
  }
  for (float& v : values) v = std::sqrt(v);
  return values;
}

TileLights::Found TileLights::distribution(const std::vector<float>& values) {
  double total = 0.0, kept = 0.0, running = 0.0;
  for (const float v : values) total += double{v};
  const double least = total * double{kLeast} / static_cast<double>(values.size());
  for (const float v : values) kept += double{v} > least ? double{v} : 0.0;
  Found out;
  for (uint32_t s = 0; s < values.size(); ++s) {
    if (!(double{values[s]} > least)) continue;
    running += double{values[s]};
    out.strata.push_back(s);
    out.values.push_back(static_cast<float>(running / kept));
  }
  if (!out.values.empty()) out.values.back() = 1.0f;
  return out;
}

LearnedStrata TileLights::at(uint32_t x, uint32_t y) const {
  const Found& tile = tiles_[y / kTileSide * tilesX_ + x / kTileSide];
  return {&strata_, {tile.strata, tile.values}, {everywhere_.strata, everywhere_.values}};
}

}  // namespace bnvpl
