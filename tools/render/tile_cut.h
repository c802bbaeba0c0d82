// The clusters that light a tile: chosen once for all of its samples, as in LightSlice (Ou &
// Pellacini 2011).
#pragma once

#include <vector>

#include "tools/render/gather.h"

namespace bnvpl {

// Dimensions of a tile's random numbers.
enum TileDraw : uint32_t { kDrawProbe, kDrawVpl, kDrawShift, kDrawPacket, kDrawRoulette };

// What to expect of a cluster at a point where one random VPL of it counts for all, W/(m2 sr),
// summed over channels. It goes by the middle of the cluster's box, which is cheaper than a bound;
// cosines are taken at the side of the box that sees most, so that it is 0 only where nothing can
// arrive.
struct ExpectedLight {
  float deviation = 0.0f;
  float most = 0.0f;  // the nearest VPL counts for all
};
ExpectedLight expectedLight(const LightNode& cluster, const Bsdf& bsdf);

// Clusters, and the deviation that is allowed to one sample, W/(m2 sr), summed over channels.
struct TileCut {
  std::vector<uint32_t> nodes;
  float allowed = 0.0f;
  float negligible = 0.0f;  // contributions below are left to chance, W/(m2 sr)
};
// Empty where nothing is to be lit. Borrows nothing.
TileCut chooseTileCut(const RayScene& rays, const VplLights& vpls, const LightTree& tree,
                      const GatherOptions& options, const TileReceivers& tile);

}  // namespace bnvpl
