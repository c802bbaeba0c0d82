// Renders the samples of a tile together, for the methods vpl and guided of --integrator: direct
// light by shadow rays to lights sampled from what the tile has learned, VPLs gathered for all
// samples at once, and rays for indirect light whose vertices the samples reuse.
#pragma once

#include <memory>
#include <optional>

#include "tools/render/gather/gather.h"
#include "tools/render/tile/allocation/sample_allocation.h"
#include "tools/render/tile/caustics/caustics.h"
#include "tools/render/tile/direct/direct_samples.h"
#include "tools/render/tile/direct/tile_light_sampler.h"
#include "tools/render/tile/reuse/indirect_rays.h"
#include "transport/spatial_light_sampler.h"
#include "transport/specular_path.h"

namespace bnvpl {

// Adds a control variate, whose mean is 0, to the indirect light of a tile's samples. `paths`:
// their camera paths.
using ControlVariateFn =
    std::function<void(const TileSamples& tile, std::span<const SpecularPath> paths)>;

// Parts that are null or empty are left out.
struct TileParts {
  GatherTile gather;  // VPLs
  bool gathersForFilter = false;  // a film filter smooths their light
  bool gathersPixelSums = false;  // finds the sum over a pixel's samples
  // Adds light that VPLs leave out to all samples at once. Returns the number of its rays.
  std::function<size_t(const TileReceivers&, std::span<Gathered>)> compensate = {};
  size_t gatherCounters = 0;     // the counters of compensation follow those of `gather`
  bool countsContinued = false;  // its first counter is that of the rays from later vertices
  std::unique_ptr<const IndirectRays> rays;
  unsigned raysEach = 0;  // from each shading point
  unsigned reuse = 1;     // samples in a group that reuses its vertices; 1: no reuse
  std::unique_ptr<const TileLightSampler> lights;  // null: one shadow ray to each light
  unsigned lightRays = 0;  // shadow rays sampled from what the tile has learned
  std::unique_ptr<const VisibleEmission> visibleEmission;
  std::unique_ptr<const Caustics> caustics;
  ControlVariateFn control;
  const SpatialLightSampler* spatialLights = nullptr;  // for near-specular vertices
  std::optional<DirectSamples> directSamples;
};

// Immutable and thread-safe.
class TileIntegrator {
 public:
  TileIntegrator(const Accelerator& accel, const LightSet& lights, TileParts parts, Only only)
      : accel_(accel), lights_(lights), parts_(std::move(parts)), only_(only) {}
  // Fills in the radiance of the tile's samples. Without a marginal cost, parts have the numbers of
  // samples that options ask for. Returns the mean cost of a sample, in the units of cost::.
  double render(const TileSamples& tile, const SampleAllocation& allocation) const;

 private:
  struct ShadingPoints;
  class TileIndirectRays;
  ShadingPoints traceCameraPaths(const TileSamples& tile, const LearnedLight& learned) const;
  Vec3 directAt(const Bsdf& bsdf, const LearnedLight& learned, uint32_t sampleIndex, uint64_t key,
                Rng& rng, const GroupSink& groups) const;
  void gatherVpls(const TileSamples& tile, const ShadingPoints& points,
                  const SampleAllocation& allocation, Vec3 meanDirect) const;
  double compensate(const TileSamples& tile, const ShadingPoints& points) const;
  double addRays(const TileSamples& tile, const ShadingPoints& points, const LearnedLight& learned,
                 const SampleAllocation& allocation, Vec3 meanDirect) const;

  const Accelerator& accel_;
  const LightSet& lights_;
  TileParts parts_;
  Only only_;
};

}  // namespace bnvpl
