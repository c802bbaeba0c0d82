// Light that reaches a surface point straight from the lights, by shadow rays.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/sampling.h"
#include "transport/bsdf.h"
#include "transport/direct_light/light_strata.h"
#include "transport/group_sink.h"
#include "transport/lights/lights.h"
#include "transport/photons/emission_guide.h"
#include "transport/photons/photon_mis.h"

namespace bnvpl {

// Which lights a vertex sends shadow rays to.
enum class LightChoice {
  One,  // one light, picked in proportion to power
  Each  // one ray to each; with more than kMaxLightsEach lights, that many picks by power
};
inline constexpr size_t kMaxLightsEach = 32;

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
  PhotonMis photons = {};
  LightGroupSink groups = {};      // receives the light by group
  LightGroupSink partGroups = {};  // receives it again; of LightWithPart, the part
};

// Where the random numbers of a vertex's shadow rays come from: independent ones, or the points of
// a scrambled Sobol sequence, which serve the rays by the learned distribution alone.
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
// Like Reflected, but returns the light by all rough lobes and, as the part, that by a Lambertian
// lobe of the value `diffuse` (albedo over pi).
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
// against `rayPdf`, the density of the rays that find the same light by hitting it. emissionHit()
// is the other half.
template <typename Reflects, typename RayPdf>
typename Reflects::Light directLight(const Accelerator& accel, const LightSet& lights,
                                     const Reflects& reflected, const LightSampling& sampling,
                                     const RayPdf& rayPdf, const LightNumbers& numbers);

// How a ray that may hit a light was sampled, for its MIS weight.
struct Arrival {
  float bsdfPdf = 0.0f;  // density times the number of such rays, 1/sr; 0: camera ray, delta lobe
  Vec3 from;             // origin of the ray
  LightChoice choice = LightChoice::One;  // choice at `from`, unless learned.strata is given
  LearnedLight learned = {};
  PhotonMis photons = {};      // weights of light that photons estimate, too
  LightGroupSink groups = {};  // receives the emission by group
};
// Emission that a ray hits, with its MIS weight: that of the surface, or, for a ray that leaves the
// scene, that of the lights at infinity.
Vec3 emissionHit(const LightSet& lights, const SurfacePoint& hit, const Arrival& arrival);
Vec3 emissionAtInfinity(const LightSet& lights, Vec3 direction, const Arrival& arrival);

// The contribution of a point of the lights to a vertex, drawn with density 1 over the unit square
// of its light, if nothing hides it. `out` tells how the vertex sees the point. False: there is
// none.
template <typename Reflects>
bool unoccludedLight(const LightSet& lights, const Reflects& reflected, const LightPoint& point,
                     LightSample& out, typename Reflects::Light& light) {
  if (!lights.sampleDirect(point.light, reflected.point().position, point.at.x, point.at.y, out))
    return false;
  light = reflected(out.wi) * out.radianceOverPdf;
  return !isBlack(light);
}
// Adds light of one light to the sums of its group.
inline void addToGroup(const LightSampling& to, uint32_t group, Vec3 light) {
  to.groups.add(group, light);
  if (to.partGroups) to.partGroups.add(group, light);
}
inline void addToGroup(const LightSampling& to, uint32_t group, const LightWithPart& light) {
  to.groups.add(group, light.all);
  if (to.partGroups) to.partGroups.add(group, light.part);
}

// Whether anything lies between a vertex and a point of the lights.
bool occluded(const Accelerator& accel, const SurfacePoint& at, const LightSample& sample);

// Shadow rays that a vertex sends to one light, in the mean.
float shadowRaysTo(const LightSet& lights, size_t light, LightChoice choice);

// One shadow ray to a point of a light that gets `count` of them in the mean.
template <typename Reflects, typename RayPdf>
typename Reflects::Light shadowRay(const Accelerator& accel, const LightSet& lights,
                                   const Reflects& reflected, const LightPoint& point, float count,
                                   const RayPdf& rayPdf, const PhotonMis& photons) {
  LightSample s;
  typename Reflects::Light light;
  if (!unoccludedLight(lights, reflected, point, s, light)) return {};
  if (occluded(accel, reflected.point(), s)) return {};
  const float other = s.pdf > 0.0f ? rayPdf(s.wi) : 0.0f;  // s.pdf 0: no ray can hit the light
  const float weight = other > 0.0f ? powerHeuristic(s.pdf * count, other) : 1.0f;
  const auto uv = [&] { return point.at; };
  return light * (weight / count *
                  photons.rayWeight(point.light, s.wi, reflected.point().position, uv,
                                    PhotonMis::shadowRayRatio(s.pdf * count, other)));
}

template <typename Reflects, typename RayPdf>
typename Reflects::Light directLight(const Accelerator& accel, const LightSet& lights,
                                     const Reflects& reflected, const LightSampling& sampling,
                                     const RayPdf& rayPdf, const LightNumbers& numbers) {
  typename Reflects::Light sum;
  const LearnedLight& learned = sampling.learned;
  const LightChoice choice = sampling.choice;
  const auto ray = [&](const LightPoint& point, float count) {
    const auto light = shadowRay(accel, lights, reflected, point, count, rayPdf, sampling.photons);
    sum += light;
    if (sampling.groups) addToGroup(sampling, lights.group(point.light), light);
  };
  if (learned.strata) {
    const LearnedStrata& strata = *learned.strata;
    for (unsigned k = 0; k < learned.rays; ++k) {
      Point2 at = numbers.point(k);
      const uint32_t stratum = strata.pick(at.x);
      const LightPoint point = strata.all->samplePoint(stratum, at);
      ray(point, static_cast<float>(learned.rays) * strata.density(stratum, point.light));
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
    const LightPoint point{static_cast<uint32_t>(light), rng.nextPoint()};
    ray(point, shadowRaysTo(lights, light, choice));
  }
  return sum;
}

}  // namespace bnvpl
