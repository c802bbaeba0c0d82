// Distributions of light sampling for each tile of the film, learned by shadow rays from the tile's
// shading points on first use, so that a shard learns only its own tiles.
#pragma once

#include <functional>
#include <mutex>
#include <vector>

#include "core/cost_probe.h"
#include "tools/render/gather/gather.h"
#include "transport/light_probes.h"

namespace bnvpl {

class TileLightSampler {
 public:
  // `raysOfTile`: number of shadow rays of a tile's samples; learning takes half as many, within
  // bounds. `shadingPoint`: returns the shading point of a pixel. `cost` is set for a cost
  // estimate. Borrows rays and lights.
  TileLightSampler(const RayScene& rays, const LightSet& lights,
                   std::function<SurfacePoint(size_t pixel)> shadingPoint, uint64_t raysOfTile,
                   uint64_t seed, CostProbe* cost = nullptr);

  // Distribution of the tile that contains the pixel. Thread-safe.
  LearnedStrata at(uint32_t x, uint32_t y) const;

 private:
  struct Tile {
    std::once_flag probed, learned;
    StrataValues found;  // from the tile's own probes
    StrataValues light;  // from the probes of the 3 x 3 tiles around
  };

  const StrataValues& probe(size_t tile) const;
  const StrataValues& learn(size_t tile) const;

  const RayScene& rays_;
  const LightSet& lights_;
  std::function<SurfacePoint(size_t pixel)> shadingPoint_;
  LightStrata strata_;
  size_t probes_;  // for each stratum
  uint64_t key_;
  size_t tilesX_, tilesY_;
  CostProbe* cost_;
  mutable std::vector<Tile> tiles_;
  StrataValues everywhere_;
};

}  // namespace bnvpl
