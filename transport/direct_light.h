// Light that reaches a surface point straight from the lights, by shadow rays.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "transport/bsdf.h"
#include "transport/light_strata.h"
#include "transport/lights.h"

namespace bnvpl {

// Which lights a vertex sends shadow rays to.
enum class LightChoice {
  One,  // picked in proportion to power
  Each  // all, one ray each; of more than kMaxLightsEach, as many picks in proportion to power
};
inline constexpr size_t kMaxLightsEach = 32;

// A light as its photons know it: of a sky that is an image, a region of like radiance, as the sun
// in it. Regions are told by the density of photons, in steps of four times.
uint64_t lampOf(const LightSet& lights, size_t light, Vec3 towards);

// Light behind specular vertices that photons bring as well: MIS by the power heuristic, of rays
// per area of the surface that they leave from and photons per area of emitter. That is the ratio
// of both ways where the specular surfaces between are flat; elsewhere, weights that sum up to one.
struct SharedWithPhotons {
  const LightSet* lights = nullptr;  // null: there are no photons
  float rays = 0.0f;                 // 1/unit^2, by the BSDF
  float photons = 0.0f;              // in all
  // Lamps (lampOf) that photons are sent from, ascending; null: all. Others are left to rays.
  const std::vector<uint64_t>* lamps = nullptr;
  // Share of what rays find. `towards`: the light, if it is at infinity.
  float ofRays(size_t light, Vec3 towards) const;
};

// Light sampling's part of the light at a vertex: multi-sample MIS by the power heuristic (Veach
// 1997, section 9.2) against `bsdfRays` rays, in the mean, that the caller sends from there by the
// BSDF; 0: light sampling is alone.
Vec3 directLight(const RayScene& rays, const LightSet& lights, const Bsdf& bsdf, LobeGroup group,
                 LightChoice choice, float bsdfRays, Rng& rng,
                 const SharedWithPhotons& shared = {});
// Light sampling by what was learned about the place: shadow rays to strata of all lights.
struct LearnedLight {
  const LearnedStrata* strata = nullptr;
  unsigned rays = 0;
};
// One ray by it; none where there is nothing to choose.
inline LearnedLight learnedBy(const LearnedStrata& strata) {
  return strata.all ? LearnedLight{&strata, 1} : LearnedLight{};
}
// The same by it; its rays are the points of a sequence (owenSobol) from `firstPoint` on.
Vec3 directLight(const RayScene& rays, const LightSet& lights, const Bsdf& bsdf, LobeGroup group,
                 const LearnedLight& learned, float bsdfRays, uint32_t firstPoint, uint64_t key);
// The same beside rays whose directions the caller does not draw by the BSDF alone: `rayPdf` is the
// density of all that they may be drawn by, 1/sr, times their number.
Vec3 directLight(const RayScene& rays, const LightSet& lights, const Bsdf& bsdf, LobeGroup group,
                 const LearnedLight& learned, const std::function<float(Vec3 wi)>& rayPdf,
                 uint32_t firstPoint, uint64_t key);
// One ray: by what was learned, or where that is nothing to a light picked in proportion to power.
Vec3 directLight(const RayScene& rays, const LightSet& lights, const Bsdf& bsdf, LobeGroup group,
                 const LearnedStrata& strata, float bsdfRays, Rng& rng,
                 const SharedWithPhotons& shared = {});
// By what was learned, or one ray to a light picked in proportion to power, beside a ray whose
// direction the caller does not draw by the BSDF alone: `rayPdf` is the density of all that it may
// draw by, 1/sr.
Vec3 directLight(const RayScene& rays, const LightSet& lights, const Bsdf& bsdf, LobeGroup group,
                 const LearnedLight& learned, const std::function<float(Vec3 wi)>& rayPdf,
                 Rng& rng);
// Light that leaves by all that an eye sees of a surface, and by a part of it that is known apart.
struct LightWithPart {
  Vec3 all, part;
  LightWithPart operator*(float k) const { return {all * k, part * k}; }
  LightWithPart operator*(Vec3 k) const { return {all * k, part * k}; }
  LightWithPart& operator+=(const LightWithPart& other) {
    all += other.all, part += other.part;
    return *this;
  }
};
inline bool isBlack(const LightWithPart& light) {
  return isBlack(light.all) && isBlack(light.part);
}
// The same, with the light that leaves by `matt`, 1/sr, which is Lambert's.
LightWithPart directLight(const RayScene& rays, const LightSet& lights, const Bsdf& bsdf,
                          LobeGroup group, Vec3 matt, const LearnedLight& learned,
                          const std::function<float(Vec3 wi)>& rayPdf, Rng& rng);
// What Lambert's law reflects of light from wi, over its value.
inline float diffuseCosine(const SurfacePoint& at, Vec3 wi) {
  return dot(at.ng, wi) > 0.0f ? std::max(0.0f, dot(at.ns, wi)) : 0.0f;
}

// How the ray that found a light was chosen, for the other half of MIS.
struct Arrival {
  float bsdfPdf = 0.0f;  // 1/sr, times the rays sent like this one; 0: camera ray, mirror or glass,
                         // which light sampling cannot reach
  Vec3 from;             // where the ray started
  LightChoice choice = LightChoice::One;  // there, unless learned.strata is given
  LearnedLight learned = {};
  SharedWithPhotons shared = {};  // light behind specular vertices
};
// Emission met by a ray, with its MIS weight: of the surface that it hit, and of what lies at
// infinity where it hit nothing.
Vec3 emissionMet(const LightSet& lights, const SurfacePoint& hit, const Arrival& arrival);
Vec3 emissionAtInfinity(const LightSet& lights, Vec3 direction, const Arrival& arrival);

// What a point of the lights would bring to the vertex if it were drawn with density 1 over the
// unit square of its light and nothing hid it; `out`: how it is seen. False: nothing.
bool unoccludedLight(const LightSet& lights, const Bsdf& bsdf, LobeGroup group,
                     const LightPlace& place, DirectSample& out, Vec3& reflected);
// Whether anything lies between.
bool isHidden(const RayScene& rays, const SurfacePoint& at, const DirectSample& sample);

}  // namespace bnvpl
