// Direct light by shadow rays, indirect light from the VPLs.
#pragma once

#include "tools/render/compensate/compensate.h"
#include "tools/render/gather/gather.h"
#include "tools/render/integrator/integrator.h"
#include "transport/specular_path.h"

namespace bnvpl {

// The thesis: direct light by shadow rays, indirect light from the VPLs. What the VPLs do not carry
// is completed by sampled rays from the vertex (Compensation).
class VplIntegrator {
 public:
  // `gather` with a point function; empty for direct light alone.
  VplIntegrator(const RayScene& rays, const LightSet& lights, Gather gather,
                Compensation compensation, unsigned nearFieldRays, Only only)
      : rays_(rays),
        lights_(lights),
        gather_(std::move(gather)),
        compensation_(std::move(compensation)),
        extensions_(compensation_ || hasSpecularLobes(rays.scene()) ? nearFieldRays : 0),
        only_(only) {}
  void render(const TileSamples& tile) const;

 private:
  struct Extension;
  void extendAll(const Bsdf& from, Vec3 throughput, uint32_t firstPoint, uint64_t pixelKey,
                 Rng& rng, RadianceSample& out) const;
  void extend(const Extension& first, Rng& rng, RadianceSample& out) const;
  Missing missingFrom(const SpecularPath& end, const ReachGrid::Lookup* near, Rng& rng) const;
  void gatherTile(const TileSamples& tile, std::span<const SpecularPath> seen,
                  std::span<const Bsdf* const> bsdf) const;

  const RayScene& rays_;
  const LightSet& lights_;
  Gather gather_;
  Compensation compensation_;
  unsigned extensions_;  // rays from each shaded point
  Only only_;
};

}  // namespace bnvpl
