// What methods of --integrator have in common that light the samples of a tile together: direct
// light by shadow rays to what the tile has learned to see, VPLs for all samples at once, and rays
// whose finds samples share.
#pragma once

#include <memory>
#include <optional>

#include "tools/render/gather/gather.h"
#include "tools/render/integrator/integrator.h"
#include "tools/render/tile/balance.h"
#include "tools/render/tile/caustics.h"
#include "tools/render/tile/direct_samples.h"
#include "tools/render/tile/indirect_rays.h"
#include "tools/render/tile/tile_lights.h"
#include "transport/specular_path.h"
#include "transport/surface_lights.h"

namespace bnvpl {

// Corrects the indirect light of a tile's samples, which saw `paths`, by what is 0 on average.
using ControlFn = std::function<void(const TileSamples& tile, std::span<const SpecularPath> paths)>;

// Null or empty: it does without.
struct TileParts {
  GatherTile gather;  // of VPLs
  std::unique_ptr<const IndirectRays> rays;
  unsigned raysEach = 0;  // from each shaded point; 0: none
  unsigned sharers = 1;   // samples that share what rays find
  std::unique_ptr<const TileLights>
      lights;              // where direct light comes from, which `lightRays` look
  unsigned lightRays = 0;  // for; null: one ray to each light
  std::unique_ptr<const SeenLight> seenLight;
  std::unique_ptr<const Caustics> caustics;
  ControlFn control;
  const SurfaceLights* surfaceLights = nullptr;  // tells sharp lobes where to look for lights
  std::optional<DirectSamples> directSamples;    // camera samples of direct light alone
};

// Thread-safe and immutable once made.
class TileIntegrator {
 public:
  TileIntegrator(const RayScene& rays, const LightSet& lights, TileParts parts, Only only)
      : rays_(rays), lights_(lights), parts_(std::move(parts)), only_(only) {}
  // Without a price: every part as its options say. Returns the mean cost of a sample.
  double render(const TileSamples& tile, const Balance& balance) const;

 private:
  struct Vertices;
  Vec3 directAt(const Bsdf& bsdf, const LearnedLight& learned, uint32_t slot, uint64_t key,
                Rng& rng) const;
  void gatherTile(const TileSamples& tile, const Vertices& at, const Balance& balance,
                  Vec3 direct) const;
  double addRays(const TileSamples& tile, const Vertices& at, const LearnedLight& learned,
                 const Balance& balance, Vec3 direct) const;
  struct SharedLight;
  class Colours;
  std::array<unsigned, 2> worthOf(const TileSamples& tile, const Colours& colours,
                                  std::span<const RaysBrought> brought,
                                  std::span<const SharedLight> shared, unsigned rays, Vec3 direct,
                                  const Balance& balance) const;
  size_t share(const TileSamples& tile, const Vertices& at, std::span<const Directions> directions,
               const Colours& colours, std::span<const RaysBrought> brought, size_t everySlot,
               std::span<SharedLight> out) const;

  const RayScene& rays_;
  const LightSet& lights_;
  TileParts parts_;
  Only only_;
};

}  // namespace bnvpl
