// The clusters that light a tile: chosen once for all of its samples, as in LightSlice (Ou &
// Pellacini 2011).
#pragma once

#include <vector>

#include "tools/render/gather/gather.h"
#include "tools/render/light_tree/cut_options.h"
#include "tools/render/tile_dimensions.h"

namespace bnvpl {

struct TileCutOptions {
  float error = 0.05f;     // standard deviation to allow a pixel, as a share of its tile's light
  uint32_t maxCut = 1000;  // clusters
};

// Clusters, and the deviation that is allowed to one sample, W/(m2 sr), summed over channels.
struct TileCut {
  std::vector<uint32_t> nodes;
  float allowed = 0.0f;
  float negligible = 0.0f;  // contributions below are left to chance, W/(m2 sr)
};
// Empty where nothing is to be lit. Borrows nothing.
TileCut chooseTileCut(const RayScene& rays, const VplLights& vpls, const LightTree& tree,
                      const TileCutOptions& options, const TileReceivers& tile);

}  // namespace bnvpl
