// Distributions of light sampling for each tile of the film, learned by shadow rays from the tile's
// shading points on first use, so that a shard learns only its own tiles.
#pragma once

#include <functional>
#include <mutex>
#include <vector>

#include "core/cost_trial.h"
#include "tools/render/film/tiles.h"
#include "transport/direct_light/strata_pilot.h"

namespace bnvpl {

class TileLightSampler {
 public:
  // `raysOfTile`: number of shadow rays of a tile's samples; learning takes half as many, within
  // bounds. `shadingPoint`: returns the shading point of a pixel. `cost` is set for a cost
  // estimate. Borrows accel and lights.
  TileLightSampler(const Accelerator& accel, const LightSet& lights,
                   std::function<SurfacePoint(size_t pixel)> shadingPoint, uint64_t raysOfTile,
                   uint64_t seed, CostTrial* cost = nullptr);

  // Distribution of the tile that contains the pixel. Thread-safe.
  LearnedStrata at(uint32_t x, uint32_t y) const;

 private:
  struct Lights {
    std::once_flag estimated, learned;
    StrataValues found;  // from the tile's own rays
    StrataValues light;  // from the rays of the 3 x 3 tiles around
  };

  const StrataValues& estimate(size_t tile) const;
  const StrataValues& learn(size_t tile) const;

  const Accelerator& accel_;
  const LightSet& lights_;
  std::function<SurfacePoint(size_t pixel)> shadingPoint_;
  LightStrata strata_;
  size_t raysEach_;  // for each stratum
  uint64_t key_;
  Tiles tiles_;
  CostTrial* cost_;
  mutable std::vector<Lights> lightsOf_;  // for each tile
  StrataValues everywhere_;
};

}  // namespace bnvpl
