// Indirect light at surface points from all VPLs: exactly, or through cuts of the light tree.
#pragma once

#include <optional>
#include <span>

#include "core/random.h"
#include "tools/render/light_tree/light_tree.h"
#include "tools/render/light_tree/vpl_sampler.h"
#include "transport/rays.h"

namespace bnvpl {

enum class GatherMethod {
  TileCuts,   // a cut for each tile, a random VPL of each cluster for each sample (tile_gather.h)
  Lightcuts,  // a cut for each sample, the same VPL of each cluster for all (Walter et al. 2005)
  All         // every VPL: the truth for a VPL set
};

struct GatherOptions {
  GatherMethod method = GatherMethod::TileCuts;
  // Tile cuts: standard deviation to allow a pixel, over the light in its tile; a prediction, which
  // so far has been two and a half to five times what was measured (docs/theory.md). Lightcuts:
  // largest error bound of a cluster, over the running total. Empty: 0.05 and 0.02.
  std::optional<float> error = std::nullopt;
  float allowedError() const {
    return error.value_or(method == GatherMethod::TileCuts ? 0.05f : 0.02f);
  }
  uint32_t maxCut = 1000;  // clusters
};

struct Gathered {
  Vec3 radiance;     // that leaves towards the viewer
  Vec3 clamped;      // what the bound on 1/d^2 removed
  uint32_t cut = 0;  // clusters or VPLs evaluated
  uint32_t shadowRays = 0;
};

// How the samples of a tile lie behind each other: slot by slot, a slot being one sample of each
// pixel, row by row.
struct TileSlots {
  uint32_t pixels = 0;     // in each slot
  uint32_t width = 1;      // of a row
  uint32_t firstSlot = 0;  // of all slots
  uint32_t allSlots = 1;   // samples a pixel
  uint64_t key = 0;        // of the tile's own random numbers
};

// The points of a tile's samples; null: nothing to light.
struct TileReceivers : TileSlots {
  std::span<const Bsdf* const> bsdf;
};

class Gatherer {
 public:
  Gatherer(const RayScene& rays, const VplLights& vpls, const GatherOptions& options,
           uint64_t seed);

  // Thread-safe, both. One result for each receiver.
  void gather(const TileReceivers& tile, std::span<Gathered> out) const;
  // All VPLs on average, by `draws` (> 0) of a VplSampler: for points whose light reaches the image
  // over one random ray among many.
  Gathered sample(const Bsdf& bsdf, unsigned draws, Rng& rng) const;

 private:
  Gathered gatherAll(const Bsdf& bsdf) const;
  Gathered gatherCut(const Bsdf& bsdf) const;

  const RayScene& rays_;
  const VplLights& vpls_;
  GatherOptions options_;
  LightTree tree_;
  VplSampler sampler_;
};

}  // namespace bnvpl
