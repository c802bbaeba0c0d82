// Indirect light at all samples of a tile from one cut of the light tree: the clusters are chosen
// once for the tile, and each sample takes one random VPL of each. Shared cuts are those of
// LightSlice (Ou & Pellacini 2011), random representatives those of Stochastic Lightcuts
// (Yuksel 2019); each packet of samples takes the same VPL, so that their shadow rays run together.
#pragma once

#include <span>

#include "tools/render/gather.h"
#include "tools/render/tile_cut.h"

namespace bnvpl {

class TileGatherer {
 public:
  // Borrows all. options.error: the standard deviation to expect of a pixel's mean, as a share of
  // the tile's light; a prediction, not a bound.
  TileGatherer(const RayScene& rays, const VplLights& vpls, const LightTree& tree,
               const GatherOptions& options)
      : rays_(rays), vpls_(vpls), tree_(tree), options_(options) {}

  // One result for each receiver. Unbiased: on average the sum over all VPLs. Thread-safe.
  void gather(const TileReceivers& tile, std::span<Gathered> out) const;

 private:
  struct Packet;
  void gatherSlot(const TileReceivers& tile, uint32_t slot, std::span<const uint32_t> packetOf,
                  const TileCut& cut, std::span<Gathered> out) const;
  bool tooNear(const LightNode& cluster, float allowed, const Packet& packet) const;
  void addCluster(const LightNode& cluster, float u, float roulette, float negligible,
                  Packet& packet) const;

  const RayScene& rays_;
  const VplLights& vpls_;
  const LightTree& tree_;
  GatherOptions options_;
};

}  // namespace bnvpl
