// Rays by the BSDF from what the camera sees: for the light that VPLs do not bring.
#pragma once

#include <span>

#include "tools/render/compensate/compensate.h"
#include "tools/render/gather/gather.h"
#include "tools/render/integrator/integrator.h"
#include "tools/render/integrator/vpl/shared_hits.h"
#include "transport/specular_path.h"
#include "transport/surface_lights.h"

namespace bnvpl {

// What many rays brought, added up.
struct RaysBrought {
  Vec3 direct, indirect, clamped, compensated;
  Vec3 ofHits;  // part of `indirect` and `compensated`: by `hits`
  std::vector<SharedHit> hits;
  // Of the indirect light that hits do not bring: each ray's squared, channels added up.
  double squares = 0.0;
  uint32_t rays = 0, shadowRays = 0;

  // `shared`: what these bring instead, by the rays of many.
  void addMeanTo(RadianceSample& out, Vec3 shared) const {
    if (rays == 0) return;
    const float each = 1.0f / static_cast<float>(rays);
    const Vec3 instead = shared - ofHits * each;
    out.direct += direct * each;
    out.indirect += indirect * each + instead;
    out.clamped += clamped * each;
    out.compensated += compensated * each + instead;
    out.shadowRays += shadowRays;
  }
};

// Where rays begin.
struct NearFieldVertex {
  const Bsdf& bsdf;
  Vec3 throughput;              // from there to the camera
  const LearnedLight& learned;  // direct light of the vertex is shared with its shadow rays
  SharedWithPhotons shared;
  bool shares = false;  // whether other samples share what rays find
};

class NearField {
 public:
  // `point`: lights what a ray has found. `shares`: rays from a vertex for whose number light is
  // shared with shadow rays and photons; others are right on average, too. `surfaceLights`: where
  // to look for the lights of what rays found; null: by power.
  NearField(const RayScene& rays, const LightSet& lights, Compensation compensation,
            unsigned shares, const SurfaceLights* surfaceLights, Only only)
      : rays_(rays),
        lights_(lights),
        compensation_(std::move(compensation)),
        shares_(shares),
        surfaceLights_(surfaceLights),
        only_(only) {}

  // Adds `count` rays, whose directions are points `first` and on of a sequence with that key.
  void send(const NearFieldVertex& from, const GatherPoint& point, unsigned count, uint32_t first,
            uint64_t key, Rng& rng, RaysBrought& out) const;

 private:
  struct Start;
  void follow(const Start& start, bool share, const GatherPoint& point, Rng& rng,
              RaysBrought& out) const;
  Missing missingFrom(const SpecularPath& end, const ReachGrid::Lookup* near, Rng& rng) const;

  const RayScene& rays_;
  const LightSet& lights_;
  Compensation compensation_;
  unsigned shares_;
  const SurfaceLights* surfaceLights_;
  Only only_;
};

}  // namespace bnvpl
