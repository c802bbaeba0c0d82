// Rays by the BSDF from what the camera sees: for the light that VPLs do not bring.
#pragma once

#include <memory>
#include <span>

#include "tools/render/compensate/compensate.h"
#include "tools/render/gather/gather.h"
#include "tools/render/integrator/integrator.h"
#include "transport/specular_path.h"
#include "transport/surface_lights.h"

namespace bnvpl {

// What many rays brought, added up, and the squares of what each of them did.
struct RaysBrought {
  Vec3 direct, indirect, clamped, compensated;
  double squares = 0.0;  // of `indirect`, channels added up
  uint32_t rays = 0, shadowRays = 0;

  void addMeanTo(RadianceSample& out) const {
    if (rays == 0) return;
    const float each = 1.0f / static_cast<float>(rays);
    out.direct += direct * each;
    out.indirect += indirect * each;
    out.clamped += clamped * each;
    out.compensated += compensated * each;
    out.shadowRays += shadowRays;
  }
};

// Where rays begin.
struct NearFieldVertex {
  const Bsdf& bsdf;
  Vec3 throughput;              // from there to the camera
  const LearnedLight& learned;  // direct light of the vertex is shared with its shadow rays
  SharedWithPhotons shared;
};

class NearField {
 public:
  // `point`: lights what a ray has found. `shares`: rays from a vertex for whose number light is
  // shared with shadow rays and photons; others are right on average, too. `surfaceLights`: where
  // to look for the lights of what rays found; null: by power.
  NearField(const RayScene& rays, const LightSet& lights, Compensation compensation,
            unsigned shares, std::unique_ptr<const SurfaceLights> surfaceLights, Only only)
      : rays_(rays),
        lights_(lights),
        compensation_(std::move(compensation)),
        shares_(shares),
        surfaceLights_(std::move(surfaceLights)),
        only_(only) {}

  // Adds `count` rays, whose directions are points `first` and on of a sequence with that key.
  void send(const NearFieldVertex& from, const GatherPoint& point, unsigned count, uint32_t first,
            uint64_t key, Rng& rng, RaysBrought& out) const;

 private:
  struct Start;
  void follow(const Start& start, const GatherPoint& point, Rng& rng, RaysBrought& out) const;
  Missing missingFrom(const SpecularPath& end, const ReachGrid::Lookup* near, Rng& rng) const;

  const RayScene& rays_;
  const LightSet& lights_;
  Compensation compensation_;
  unsigned shares_;
  std::unique_ptr<const SurfaceLights> surfaceLights_;
  Only only_;
};

}  // namespace bnvpl
