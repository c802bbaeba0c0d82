// Indirect light at all samples of a tile from one cut of the light tree: the clusters are chosen
// once for the tile, and each sample takes one random VPL of each. Shared cuts are those of
// LightSlice (Ou & Pellacini 2011), random representatives those of Stochastic Lightcuts
// (Yuksel 2019); each packet of samples takes the same VPL.
#pragma once

#include <span>

#include "tools/render/gather.h"

namespace bnvpl {

// Writes one result for each receiver. Unbiased: on average the sum over all VPLs. Thread-safe.
// options.error: the standard deviation to expect of a pixel's mean, as a share of the tile's
// light; a prediction, not a bound.
void gatherTile(const RayScene& rays, const VplLights& vpls, const LightTree& tree,
                const GatherOptions& options, const TileReceivers& tile, std::span<Gathered> out);

}  // namespace bnvpl
