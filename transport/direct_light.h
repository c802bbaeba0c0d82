// Light that reaches a surface point straight from the lights, by shadow rays.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/sampling.h"
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

// Shadow rays by the learned distribution over the strata of all lights.
struct LearnedLight {
  const LearnedStrata* strata = nullptr;  // null: nothing was learned
  unsigned rays = 0;
};
// One such ray; none where nothing was learned.
inline LearnedLight learnedBy(const LearnedStrata& strata) {
  return strata.all ? LearnedLight{&strata, 1} : LearnedLight{};
}

// How a vertex samples the lights: by the learned distribution, or else by `choice`.
struct LightSampling {
  LearnedLight learned = {};
  LightChoice choice = LightChoice::One;
  SharedWithPhotons photons = {};
};

// Where the random numbers of a vertex's shadow rays come from: independent ones, or the points of
// a scrambled Sobol sequence for the rays by the learned distribution.
class LightNumbers {
 public:
  explicit LightNumbers(Rng& rng) : rng_(&rng) {}
  LightNumbers(uint32_t firstPoint, uint64_t key) : first_(firstPoint), key_(key) {}
  // A sequence with a key of its own.
  static LightNumbers sequence(Rng& rng) {
    return {0, mix64(static_cast<uint64_t>(rng.next() * 0x1p24f))};
  }
  Point2 point(unsigned ray) const {
    return rng_ ? rng_->nextPoint() : owenSobol(first_ + ray, key_);
  }
  Rng& independent() const { return *rng_; }

 private:
  Rng* rng_ = nullptr;
  uint32_t first_ = 0;
  uint64_t key_ = 0;
};

// What a vertex reflects towards the viewer of unit radiance from `wi`: BSDF times cosine.
struct Reflected {
  using Light = Vec3;
  const Bsdf& bsdf;
  LobeGroup group = LobeGroup::Rough;
  const SurfacePoint& point() const { return bsdf.point(); }
  Light operator()(Vec3 wi) const { return bsdf.eval(group, wi); }
};

// Cosine of Lambert's law for light from wi; 0 below the surface.
inline float diffuseCosine(const SurfacePoint& at, Vec3 wi) {
  return dot(at.ng, wi) > 0.0f ? std::max(0.0f, dot(at.ns, wi)) : 0.0f;
}
// Light that leaves a vertex by all its lobes, and by its diffuse lobe alone.
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
// The same by all lobes and by `diffuse`, albedo over pi.
struct ReflectedWithDiffuse {
  using Light = LightWithPart;
  const Bsdf& bsdf;
  Vec3 diffuse;
  const SurfacePoint& point() const { return bsdf.point(); }
  Light operator()(Vec3 wi) const {
    return {bsdf.eval(LobeGroup::Rough, wi), diffuse * diffuseCosine(bsdf.point(), wi)};
  }
};

// Density of the rays that the caller sends from a vertex besides, 1/sr times their number: none,
// or `count` BSDF rays. A caller that draws directions in another way passes its own density.
struct NoRays {
  float operator()(Vec3) const { return 0.0f; }
};
struct BsdfRays {
  const Bsdf& bsdf;
  float count = 1.0f;
  LobeGroup group = LobeGroup::Rough;
  float operator()(Vec3 wi) const { return count > 0.0f ? count * bsdf.pdf(group, wi) : 0.0f; }
};

// Light sampling's half of next-event estimation at a vertex (Veach 1997, section 9.2): the sum
// over its shadow rays of
//   f(wi) cos(wi) L_e(wi) / (n p(wi)) * w(wi),
// with n p the density of the shadow rays towards wi and w the weight of the power heuristic
// against `rayPdf`, the density of the rays that find the same light by hitting it. emissionMet()
// is the other half.
template <typename Reflects, typename RayPdf>
typename Reflects::Light directLight(const RayScene& rays, const LightSet& lights,
                                     const Reflects& reflected, const LightSampling& sampling,
                                     const RayPdf& rayPdf, const LightNumbers& numbers);

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

// The contribution of a point of the lights to a vertex, drawn with density 1 over the unit square
// of its light, if nothing hides it. `out` tells how the vertex sees the point. False: there is
// none.
template <typename Reflects>
bool unoccludedLight(const LightSet& lights, const Reflects& reflected, const LightPlace& place,
                     DirectSample& out, typename Reflects::Light& light) {
  if (!lights.sampleDirect(place.light, reflected.point().position, place.at.x, place.at.y, out))
    return false;
  light = reflected(out.wi) * out.radianceOverPdf;
  return !isBlack(light);
}
// Whether anything lies between a vertex and a point of the lights.
bool isHidden(const RayScene& rays, const SurfacePoint& at, const DirectSample& sample);

// Shadow rays that a vertex sends to one light, in the mean.
float shadowRaysTo(const LightSet& lights, size_t light, LightChoice choice);

// One shadow ray to a point of a light that gets `count` of them in the mean.
template <typename Reflects, typename RayPdf>
typename Reflects::Light shadowRay(const RayScene& rays, const LightSet& lights,
                                   const Reflects& reflected, const LightPlace& place, float count,
                                   const RayPdf& rayPdf, const SharedWithPhotons& photons) {
  DirectSample s;
  typename Reflects::Light light;
  if (!unoccludedLight(lights, reflected, place, s, light)) return {};
  if (isHidden(rays, reflected.point(), s)) return {};
  const float other = s.pdf > 0.0f ? rayPdf(s.wi) : 0.0f;  // s.pdf 0: no ray can hit the light
  const float weight = other > 0.0f ? powerHeuristic(s.pdf * count, other) : 1.0f;
  return light * (weight * photons.ofRays(place.light, s.wi) / count);
}

template <typename Reflects, typename RayPdf>
typename Reflects::Light directLight(const RayScene& rays, const LightSet& lights,
                                     const Reflects& reflected, const LightSampling& sampling,
                                     const RayPdf& rayPdf, const LightNumbers& numbers) {
  typename Reflects::Light sum;
  const auto& [learned, choice, photons] = sampling;
  if (learned.strata) {
    const LearnedStrata& strata = *learned.strata;
    for (unsigned k = 0; k < learned.rays; ++k) {
      Point2 at = numbers.point(k);
      const uint32_t stratum = strata.pick(at.x);
      const LightPlace place = strata.all->place(stratum, at);
      const float count = static_cast<float>(learned.rays) * strata.probability(stratum) /
                          strata.all->share(stratum) * strata.all->lightShare(place.light);
      sum += shadowRay(rays, lights, reflected, place, count, rayPdf, photons);
    }
    return sum;
  }
  Rng& rng = numbers.independent();
  const bool all = choice == LightChoice::Each && lights.size() <= kMaxLightsEach;
  const size_t count = all ? lights.size() : choice == LightChoice::Each ? kMaxLightsEach : 1;
  for (size_t k = 0; k < count && lights.size() > 0; ++k) {
    float probability = 1.0f;
    const size_t light = all ? k : lights.pick(rng.next(), probability);
    if (!(probability > 0.0f)) continue;
    const LightPlace place{static_cast<uint32_t>(light), rng.nextPoint()};
    sum += shadowRay(rays, lights, reflected, place, shadowRaysTo(lights, light, choice), rayPdf,
                     photons);
  }
  return sum;
}

}  // namespace bnvpl
