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
  One,  // one light, picked in proportion to power
  Each  // one ray to each; with more than kMaxLightsEach lights, that many picks by power
};
inline constexpr size_t kMaxLightsEach = 32;

// Identifies the emitter of photons: a light, or, in an environment image, a region of similar
// radiance such as the sun. Regions are classes of photon density, in steps of a factor of 4.
uint64_t lampOf(const LightSet& lights, size_t light, Vec3 towards);

// MIS weights, by the power heuristic, of light through specular vertices that photons estimate,
// too. Densities are rays per area of the receiver and photons per area of the emitter. Their ratio
// is exact if the specular surfaces between are flat; otherwise the weights still sum to one.
struct SharedWithPhotons {
  const LightSet* lights = nullptr;  // null: there are no photons
  float rays = 0.0f;                 // BSDF rays per area, 1/unit^2
  float photons = 0.0f;              // number of photons from all lights
  // Lamps (lampOf) that emit photons, ascending; null: all do. Rays alone estimate the others.
  const std::vector<uint64_t>* lamps = nullptr;
  // Weight of rays. `towards` is the direction towards a light at infinity.
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

// How a ray that may hit a light was sampled, for its MIS weight.
struct Arrival {
  float bsdfPdf = 0.0f;  // density times the number of such rays, 1/sr; 0: camera ray, delta lobe
  Vec3 from;             // origin of the ray
  LightChoice choice = LightChoice::One;  // choice at `from`, unless learned.strata is given
  LearnedLight learned = {};
  SharedWithPhotons shared = {};  // weights of light through specular vertices
};
// Emission that a ray hits, with its MIS weight: that of the surface, or, for a ray that leaves the
// scene, that of the lights at infinity.
Vec3 emissionMet(const LightSet& lights, const SurfacePoint& hit, const Arrival& arrival);
Vec3 emissionAtInfinity(const LightSet& lights, Vec3 direction, const Arrival& arrival);

// What a point of the lights would bring to the vertex if it were drawn with density 1 over the
// unit square of its light and nothing hid it; `out`: how it is seen. False: nothing.
bool unoccludedLight(const LightSet& lights, const Bsdf& bsdf, LobeGroup group,
                     const LightPlace& place, DirectSample& out, Vec3& reflected);
// Whether anything lies between.
bool isHidden(const RayScene& rays, const SurfacePoint& at, const DirectSample& sample);

}  // namespace bnvpl
