// Light that reaches a surface point straight from the lights, by shadow rays.
#pragma once

#include "scene/bsdf.h"
#include "scene/lights.h"

namespace bnvpl {

// One shadow ray towards one light. `lightProbability` is the chance with which the caller picked
// it. With `mis`, weighted against sampling the same direction by the BSDF (power heuristic).
Vec3 sampleLight(const RayScene& rays, const LightSet& lights, const Bsdf& bsdf, LobeGroup group,
                 size_t light, float lightProbability, bool mis, Rng& rng);

// All lights, one shadow ray each, by light sampling alone; of more than kMaxLightsEach, as many
// picks in proportion to power.
inline constexpr size_t kMaxLightsEach = 32;
Vec3 directLight(const RayScene& rays, const LightSet& lights, const Bsdf& bsdf, LobeGroup group,
                 Rng& rng);

// One light picked in proportion to power, weighted for MIS against BSDF sampling.
Vec3 directLightMis(const RayScene& rays, const LightSet& lights, const Bsdf& bsdf, LobeGroup group,
                    Rng& rng);

// How the ray that found a light was chosen, for the other half of MIS.
struct Arrival {
  float bsdfPdf = 0.0f;  // 1/sr; 0: camera ray, mirror or glass, which light sampling cannot reach
  Vec3 from;             // where the ray started
};
// Emission met by a ray: of the surface that it hit, and of what lies at infinity where it hit
// nothing.
Vec3 emissionMet(const LightSet& lights, const SurfacePoint& hit, const Arrival& arrival);
Vec3 emissionAtInfinity(const LightSet& lights, Vec3 direction, const Arrival& arrival);

}  // namespace bnvpl
