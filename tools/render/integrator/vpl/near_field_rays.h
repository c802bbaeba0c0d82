// Rays by the BSDF from what the camera sees: for the light that VPLs do not bring.
#pragma once

#include <span>

#include "tools/render/compensate/compensate.h"
#include "tools/render/gather/gather.h"
#include "tools/render/integrator/integrator.h"
#include "tools/render/tile/indirect_rays.h"
#include "transport/specular_path.h"
#include "transport/surface_lights.h"

namespace bnvpl {

class NearFieldRays : public IndirectRays {
 public:
  // `point`: lights what a ray has found. `shares`: rays from a vertex for whose number light is
  // shared with shadow rays and photons; others are right on average, too. `surfaceLights`: where
  // to look for the lights of what rays found; null: by power.
  NearFieldRays(const RayScene& rays, const LightSet& lights, GatherPoint point,
                Compensation compensation, unsigned shares, const SurfaceLights* surfaceLights,
                Only only)
      : rays_(rays),
        lights_(lights),
        point_(std::move(point)),
        compensation_(std::move(compensation)),
        shares_(shares),
        surfaceLights_(surfaceLights),
        only_(only) {}

  void send(const RaysFrom& from, unsigned count, uint32_t first, uint64_t key,
            RaysBrought& out) const override;
  double costOfRay() const override;

 private:
  // `near`: the VPLs at the first hit.
  void follow(const FirstLink& start, const ReachGrid::Lookup& near, bool share,
              RaysBrought& out) const;
  Missing missingFrom(const SurfacePoint& hit, bool straight, const ReachGrid::Lookup* near,
                      Rng& rng) const;

  const RayScene& rays_;
  const LightSet& lights_;
  GatherPoint point_;
  Compensation compensation_;
  unsigned shares_;
  const SurfaceLights* surfaceLights_;
  Only only_;
};

}  // namespace bnvpl
