// Direct light by shadow rays, indirect light from the VPLs.
#pragma once

#include <memory>
#include <optional>

#include "tools/render/compensate/compensate.h"
#include "tools/render/gather/gather.h"
#include "tools/render/integrator/integrator.h"
#include "tools/render/integrator/vpl/caustics.h"
#include "tools/render/integrator/vpl/direct_samples.h"
#include "tools/render/integrator/vpl/pixel_control.h"
#include "tools/render/integrator/vpl/tile_lights.h"
#include "transport/specular_path.h"
#include "transport/surface_lights.h"

namespace bnvpl {

// The thesis: direct light by shadow rays, indirect light from the VPLs. What the VPLs do not carry
// is completed by sampled rays from the vertex (Compensation).
class VplIntegrator {
 public:
  // `gather` with a point function; empty for direct light alone. `tileLights`: where direct light
  // comes from, which `lightRays` look for; null: one ray to each light. `seenLight`,
  // `pixelControl`, `caustics`: may be null. `surfaceLights`: where near-field rays look for the
  // lights of what they found; null: by power. `nearFieldRays`: from each shaded point.
  // `directSamples`: where direct light has camera samples of its own.
  VplIntegrator(const RayScene& rays, const LightSet& lights, Gather gather,
                Compensation compensation, unsigned nearFieldRays,
                std::unique_ptr<const SurfaceLights> surfaceLights,
                std::unique_ptr<const TileLights> tileLights, unsigned lightRays,
                std::unique_ptr<const SeenLight> seenLight,
                std::unique_ptr<const PixelControl> pixelControl,
                std::unique_ptr<const Caustics> caustics,
                std::optional<DirectSamples> directSamples, Only only)
      : rays_(rays),
        lights_(lights),
        gather_(std::move(gather)),
        compensation_(std::move(compensation)),
        extensions_(nearFieldRays),
        surfaceLights_(std::move(surfaceLights)),
        tileLights_(std::move(tileLights)),
        lightRays_(lightRays),
        seenLight_(std::move(seenLight)),
        pixelControl_(std::move(pixelControl)),
        caustics_(std::move(caustics)),
        directSamples_(directSamples),
        only_(only) {}
  void render(const TileSamples& tile) const;

 private:
  struct Extension;
  struct Points;
  Vec3 directAt(const Bsdf& bsdf, const LearnedLight& learned, const Points& points,
                Rng& rng) const;
  void extendAll(const Bsdf& from, Vec3 throughput, const LearnedLight& learned,
                 const SharedWithPhotons& shared, const Points& points, Rng& rng,
                 RadianceSample& out) const;
  void extend(const Extension& first, Rng& rng, RadianceSample& out) const;
  Missing missingFrom(const SpecularPath& end, const ReachGrid::Lookup* near, Rng& rng) const;
  void gatherTile(const TileSamples& tile, std::span<const SpecularPath> seen,
                  std::span<const Bsdf* const> bsdf) const;

  const RayScene& rays_;
  const LightSet& lights_;
  Gather gather_;
  Compensation compensation_;
  unsigned extensions_;  // rays from each shaded point
  std::unique_ptr<const SurfaceLights> surfaceLights_;
  std::unique_ptr<const TileLights> tileLights_;
  unsigned lightRays_;
  std::unique_ptr<const SeenLight> seenLight_;
  std::unique_ptr<const PixelControl> pixelControl_;
  std::unique_ptr<const Caustics> caustics_;
  std::optional<DirectSamples> directSamples_;
  Only only_;
};

}  // namespace bnvpl
