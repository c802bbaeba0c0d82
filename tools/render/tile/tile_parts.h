// What a TileIntegrator is made of, and what its parts know of a tile.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "tools/render/gather/gather.h"
#include "tools/render/tile/caustics/caustics.h"
#include "tools/render/tile/direct/direct_samples.h"
#include "tools/render/tile/direct/tile_light_sampler.h"
#include "tools/render/tile/indirect_rays.h"
#include "transport/direct_light/spatial_light_sampler.h"
#include "transport/specular_path.h"

namespace bnvpl {

// Adds a control variate, whose mean is 0, to the indirect light of a tile's samples. `paths`:
// their camera paths.
using ControlVariateFn =
    std::function<void(const TileSamples& tile, std::span<const SpecularPath> paths)>;

// Parts that are null or empty are left out.
struct TileParts {
  TileGatherFn gather;            // VPLs
  bool gathersForFilter = false;  // a film filter smooths their light
  bool gathersPixelSums = false;  // finds the sum over a pixel's samples
  // Adds light that VPLs leave out to all samples at once, for compensations that work by tile;
  // those that work ray by ray have `rays`. Returns the number of its rays.
  std::function<size_t(const TileReceivers&, std::span<Gathered>)> compensateTile = {};
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

// Ends of the camera paths of a tile's samples.
struct ShadingPoints {
  std::vector<SpecularPath> paths;
  std::vector<Bsdf> bsdfs;        // one for each shading point
  std::vector<const Bsdf*> bsdf;  // for each sample, in `bsdfs`; null: no shading point
  size_t indexOf(size_t sample) const { return static_cast<size_t>(bsdf[sample] - bsdfs.data()); }
};

}  // namespace bnvpl
