// Renders the samples of a tile together, for the methods vpl and guided of --integrator: direct
// light by shadow rays to lights sampled from what the tile has learned, VPLs gathered for all
// samples at once, and rays for indirect light whose vertices the samples reuse.
#pragma once

#include "tools/render/tile/allocation/sample_allocation.h"
#include "tools/render/tile/tile_parts.h"

namespace bnvpl {

// Immutable and thread-safe.
class TileIntegrator {
 public:
  TileIntegrator(const Accelerator& accel, const LightSet& lights, TileParts parts,
                 ShownLight shown)
      : accel_(accel), lights_(lights), parts_(std::move(parts)), shown_(shown) {}
  // Fills in the radiance of the tile's samples. Without a marginal cost, parts have the numbers of
  // samples that options ask for. Returns the mean cost of a sample, in the units of cost::.
  double render(const TileSamples& tile, const SampleAllocation& allocation) const;

 private:
  ShadingPoints traceCameraPaths(const TileSamples& tile, const LearnedLight& learned) const;
  Vec3 addDirectLight(const TileSamples& tile, const ShadingPoints& points,
                      const LearnedLight& learned) const;
  Vec3 directAt(const Bsdf& bsdf, const LearnedLight& learned, uint32_t sampleIndex, uint64_t key,
                Rng& rng, const LightGroupSink& groups) const;
  void gatherVpls(const TileSamples& tile, const ShadingPoints& points,
                  const SampleAllocation& allocation, Vec3 meanDirect) const;
  double compensateTile(const TileSamples& tile, const ShadingPoints& points) const;
  double addRays(const TileSamples& tile, const ShadingPoints& points, const LearnedLight& learned,
                 const SampleAllocation& allocation, Vec3 meanDirect) const;

  const Accelerator& accel_;
  const LightSet& lights_;
  TileParts parts_;
  ShownLight shown_;
};

}  // namespace bnvpl
