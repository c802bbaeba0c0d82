// Which parts of the lights each tile of the film sees: learned by shadow rays from what the camera
// sees in it, when the tile is asked for, so that a shard learns its own tiles alone.
#pragma once

#include <functional>
#include <mutex>
#include <vector>

#include "tools/render/gather/gather.h"
#include "transport/light_probes.h"

namespace bnvpl {

class TileLights {
 public:
  // `raysOfTile`: what the samples of a tile will send; learning takes half as many, within bounds.
  // `seen`: by a pixel of the film. Borrows rays and lights.
  TileLights(const RayScene& rays, const LightSet& lights,
             std::function<SurfacePoint(size_t pixel)> seen, uint64_t raysOfTile, uint64_t seed);

  // Of the tile with that pixel. From any number of threads.
  LearnedStrata at(uint32_t x, uint32_t y) const;

 private:
  struct Tile {
    std::once_flag probed, learned;
    StrataValues found;  // by its probes
    StrataValues light;  // by those of the tiles around too; running sums
  };

  const StrataValues& probe(size_t tile) const;
  const StrataValues& learn(size_t tile) const;

  const RayScene& rays_;
  const LightSet& lights_;
  std::function<SurfacePoint(size_t pixel)> seen_;
  LightStrata strata_;
  size_t probes_;  // of a stratum
  uint64_t key_;
  size_t tilesX_, tilesY_;
  mutable std::vector<Tile> tiles_;
  StrataValues everywhere_;
};

}  // namespace bnvpl
