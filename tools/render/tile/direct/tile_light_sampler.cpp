#include "tools/render/tile/direct/tile_light_sampler.h"

#include <algorithm>

#include "core/parallel.h"
#include "core/random_streams.h"

namespace bnvpl {

namespace {

constexpr size_t kMaxRaysEach = 16;  // for each stratum; those of the tiles around add to them
constexpr size_t kFilmTiles = 256;   // tiles, evenly spaced, whose mean stands for the film

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
      tiles_(accel.scene().film),
      cost_(cost),
      lightsOf_(tiles_.count()) {
  if (strata_.size() < 2) return;
  std::vector<StrataValues> some(std::min(tiles_.count(), kFilmTiles));
  parallelFor(some.size(), 1, [&](size_t i) {
    PooledStrata own(strata_.size());
    own.add(estimate(i * tiles_.count() / some.size()));
    some[i] = own.distribution();
  });
  everywhere_ = meanOf(some, strata_.size());
}

const StrataValues& TileLightSampler::estimate(size_t tile) const {
  Lights& own = lightsOf_[tile];
  std::call_once(own.estimated, [&] {
    const CostTrial::Unit part(cost_, cost_ ? cost_->partOfShared(9.0) : 1.0);
    const Tile pixels = tiles_.at(tile);
    std::vector<SurfacePoint> points;
    for (uint32_t p = 0; p < pixels.pixels(); ++p)
      points.push_back(shadingPoint_(tiles_.pixelIndex(pixels, p)));
    std::vector<Bsdf> bsdfs;  // borrow the points
    bsdfs.reserve(points.size());
    for (const SurfacePoint& p : points) {
      if (p.triangle != kNone) bsdfs.emplace_back(accel_.scene(), p);
    }
    Rng rng(key_, tile);
    own.found = estimateStrata(accel_, lights_, strata_, bsdfs, raysEach_, rng);
  });
  return own.found;
}

const StrataValues& TileLightSampler::learn(size_t tile) const {
  Lights& own = lightsOf_[tile];
  std::call_once(own.learned, [&] {
    const size_t x = tile % tiles_.across(), y = tile / tiles_.across();
    PooledStrata sum(strata_.size());
    for (size_t j = y > 0 ? y - 1 : 0; j < std::min(tiles_.down(), y + 2); ++j) {
      for (size_t i = x > 0 ? x - 1 : 0; i < std::min(tiles_.across(), x + 2); ++i)
        sum.add(estimate(j * tiles_.across() + i));
    }
    own.light = sum.distribution();
  });
  return own.light;
}

LearnedStrata TileLightSampler::at(uint32_t x, uint32_t y) const {
  if (strata_.size() < 2) return {&strata_, {}, {}};
  return {&strata_, learn(y / kTileSide * tiles_.across() + x / kTileSide).seen(),
          everywhere_.seen()};
}

}  // namespace bnvpl
