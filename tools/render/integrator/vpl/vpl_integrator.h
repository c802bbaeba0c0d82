// Direct light by shadow rays, indirect light from the VPLs.
#pragma once

#include <memory>
#include <optional>

#include "tools/render/gather/gather.h"
#include "tools/render/integrator/integrator.h"
#include "tools/render/integrator/vpl/balance.h"
#include "tools/render/integrator/vpl/caustics.h"
#include "tools/render/integrator/vpl/direct_samples.h"
#include "tools/render/integrator/vpl/near_field.h"
#include "tools/render/integrator/vpl/pixel_control.h"
#include "tools/render/integrator/vpl/tile_lights.h"
#include "transport/specular_path.h"
#include "transport/surface_lights.h"

namespace bnvpl {

// The thesis: direct light by shadow rays, indirect light from the VPLs. What the VPLs do not carry
// is completed by sampled rays from the vertex (NearField).
class VplIntegrator {
 public:
  // `gather` with a point function; empty for direct light alone. `nearFieldRays`: from each shaded
  // point. `sharers`: samples that share what these find. `tileLights`: where direct light
  // comes from, which `lightRays` look for; null: one ray to each light. `seenLight`,
  // `pixelControl`, `caustics`, `surfaceLights`: may be null. The last tells sharp
  // lobes where to look for lights.
  // `directSamples`: where direct light has camera samples
  // of its own.
  VplIntegrator(const RayScene& rays, const LightSet& lights, Gather gather, NearField nearField,
                unsigned nearFieldRays, unsigned sharers,
                std::unique_ptr<const TileLights> tileLights, unsigned lightRays,
                std::unique_ptr<const SeenLight> seenLight,
                std::unique_ptr<const PixelControl> pixelControl,
                std::unique_ptr<const Caustics> caustics, const SurfaceLights* surfaceLights,
                std::optional<DirectSamples> directSamples, Only only)
      : rays_(rays),
        lights_(lights),
        gather_(std::move(gather)),
        nearField_(std::move(nearField)),
        nearFieldRays_(nearFieldRays),
        sharers_(sharers),
        tileLights_(std::move(tileLights)),
        lightRays_(lightRays),
        seenLight_(std::move(seenLight)),
        pixelControl_(std::move(pixelControl)),
        caustics_(std::move(caustics)),
        surfaceLights_(surfaceLights),
        directSamples_(directSamples),
        only_(only) {}
  // Without a price: every part as its options say. Returns the mean cost of a sample.
  double render(const TileSamples& tile, const Balance& balance) const;

 private:
  struct Vertices;
  Vec3 directAt(const Bsdf& bsdf, const LearnedLight& learned, uint32_t slot, uint64_t key,
                Rng& rng) const;
  void gatherTile(const TileSamples& tile, const Vertices& at, const Balance& balance,
                  Vec3 direct) const;
  double addNearField(const TileSamples& tile, const Vertices& at, const LearnedLight& learned,
                      const Balance& balance, Vec3 direct) const;
  struct SharedLight;
  static std::vector<PixelDraws> drawsOf(const TileSamples& tile,
                                         std::span<const RaysBrought> brought,
                                         std::span<const SharedLight> shared, unsigned rays,
                                         Vec3 direct);
  size_t share(const TileSamples& tile, const Vertices& at, std::span<const RaysBrought> brought,
               size_t everySlot, std::span<SharedLight> out) const;

  const RayScene& rays_;
  const LightSet& lights_;
  Gather gather_;
  NearField nearField_;
  unsigned nearFieldRays_, sharers_;
  std::unique_ptr<const TileLights> tileLights_;
  unsigned lightRays_;
  std::unique_ptr<const SeenLight> seenLight_;
  std::unique_ptr<const PixelControl> pixelControl_;
  std::unique_ptr<const Caustics> caustics_;
  const SurfaceLights* surfaceLights_;
  std::optional<DirectSamples> directSamples_;
  Only only_;
};

}  // namespace bnvpl
