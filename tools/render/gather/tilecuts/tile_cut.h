// The cut of a tile: clusters that are chosen once for all of its samples, as in LightSlice (Ou &
// Pellacini 2011).
#pragma once

#include <vector>

#include "tools/render/gather/gather.h"
#include "tools/render/light_tree/cut_options.h"
#include "tools/render/tile_dimensions.h"

namespace bnvpl {

struct TileCutOptions {
  float error;      // allowed standard deviation of a pixel, as a share of its tile's light
  uint32_t maxCut;  // maximal number of clusters
};

// Clusters, and the standard deviation that one sample may have, W/(m2 sr), summed over channels.
struct TileCut {
  std::vector<uint32_t> nodes;
  float allowedDeviation = 0.0f;
  float negligible = 0.0f;  // contribution below which Russian roulette applies, W/(m2 sr)
};
// Chooses the cut of a tile; it is empty if the tile has no receivers.
TileCut chooseTileCut(const Accelerator& accel, const VplLights& vpls, const LightTree& tree,
                      const TileCutOptions& options, const TileReceivers& tile);

}  // namespace bnvpl
