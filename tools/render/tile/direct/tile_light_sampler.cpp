#include "tools/render/tile/direct/tile_light_sampler.h"

#include <algorithm>

#include "core/parallel.h"
#include "core/random_streams.h"

namespace bnvpl {

namespace {

constexpr size_t kMaxRaysEach = 16;  // for each stratum; those of the tiles around add to them
constexpr size_t kFilmTiles = 256;  // tiles, evenly spaced, whose mean stands for the film

}  // namespace

TileLightSampler::TileLightSampler(const Accelerator& accel, const LightSet& lights,
                                   std::function<SurfacePoint(size_t pixel)> shadingPoint,
                                   uint64_t raysOfTile, uint64_t seed, CostTrial* cost)
    : accel_(accel),
      lights_(lights),
      shadingPoint_(std::move(shadingPoint)),
      strata_(lights),
      raysEach_(std::clamp<uint64_t>(raysOfTile / 2 / std::max<size_t>(1, strata_.size()), 1,
                                     kMaxRaysEach)),
      key_(streamKey(seed, RandomStream::TileLightSampler)),
      tilesX_((accel.scene().film.width + kTileSide - 1) / kTileSide),
      tilesY_((accel.scene().film.height + kTileSide - 1) / kTileSide),
      cost_(cost),
      tiles_(tilesX_ * tilesY_) {
  if (strata_.size() < 2) return;
  std::vector<StrataValues> some(std::min(tiles_.size(), kFilmTiles));
  parallelFor(some.size(), 1, [&](size_t i) {
    PooledStrata own(strata_.size());
    own.add(estimate(i * tiles_.size() / some.size()));
    some[i] = own.distribution();
  });
  everywhere_ = meanOf(some, strata_.size());
}

const StrataValues& TileLightSampler::estimate(size_t tile) const {
  Tile& t = tiles_[tile];
  std::call_once(t.estimated, [&] {
    const CostTrial::Unit part(cost_, cost_ ? cost_->partOfShared(9.0) : 1.0);
    const Film& film = accel_.scene().film;
    const auto x0 = static_cast<uint32_t>(tile % tilesX_) * kTileSide,
               y0 = static_cast<uint32_t>(tile / tilesX_) * kTileSide;
    std::vector<SurfacePoint> points;
    for (uint32_t y = y0; y < std::min(film.height, y0 + kTileSide); ++y) {
      for (uint32_t x = x0; x < std::min(film.width, x0 + kTileSide); ++x)
        points.push_back(shadingPoint_(size_t{y} * film.width + x));
    }
    std::vector<Bsdf> bsdfs;  // borrow the points
    bsdfs.reserve(points.size());
    for (const SurfacePoint& p : points) {
      if (p.triangle != kNone) bsdfs.emplace_back(accel_.scene(), p);
    }
    Rng rng(key_, tile);
    t.found = estimateStrata(accel_, lights_, strata_, bsdfs, raysEach_, rng);
  });
  return t.found;
}

const StrataValues& TileLightSampler::learn(size_t tile) const {
  Tile& t = tiles_[tile];
  std::call_once(t.learned, [&] {
    const size_t x = tile % tilesX_, y = tile / tilesX_;
    PooledStrata sum(strata_.size());
    for (size_t j = y > 0 ? y - 1 : 0; j < std::min(tilesY_, y + 2); ++j) {
      for (size_t i = x > 0 ? x - 1 : 0; i < std::min(tilesX_, x + 2); ++i)
        sum.add(estimate(j * tilesX_ + i));
    }
    t.light = sum.distribution();
  });
  return t.light;
}

LearnedStrata TileLightSampler::at(uint32_t x, uint32_t y) const {
  if (strata_.size() < 2) return {&strata_, {}, {}};
  return {&strata_, learn(y / kTileSide * tilesX_ + x / kTileSide).seen(), everywhere_.seen()};
}

}  // namespace bnvpl
