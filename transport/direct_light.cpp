#include "transport/direct_light.h"

#include <algorithm>
#include <cmath>

#include "core/sampling.h"

namespace bnvpl {

namespace {

// Shadow rays that a vertex sends to a light, in the mean.
float raysTo(const LightSet& lights, size_t light, LightChoice choice) {
  if (choice == LightChoice::One) return lights.pickProbability(light);
  if (lights.size() <= kMaxLightsEach) return 1.0f;
  return static_cast<float>(kMaxLightsEach) * lights.pickProbability(light);
}

// Share of a hit found by the BSDF, against light sampling. `place`: -> where on the light it is.
template <typename Place>
float hitWeight(const LightSet& lights, size_t light, float lightPdf, const Arrival& arrival,
                const Place& place) {
  if (!(arrival.bsdfPdf > 0.0f)) return 1.0f;
  const LearnedLight& learned = arrival.learned;
  const float rays = learned.strata
                         ? static_cast<float>(learned.rays) *
                               learned.strata->density({static_cast<uint32_t>(light), place()})
                         : raysTo(lights, light, arrival.choice);
  return powerHeuristic(arrival.bsdfPdf, lightPdf * rays);
}

// -> density of that many rays by the BSDF.
auto raysByBsdf(const Bsdf& bsdf, LobeGroup group, float rays) {
  return [&bsdf, group, rays](Vec3 wi) { return rays * bsdf.pdf(group, wi); };
}

// What a vertex reflects of radiance from wi, with the cosine: for the functions below.
struct ByBsdf {
  using Light = Vec3;
  const Bsdf& bsdf;
  LobeGroup group;
  const SurfacePoint& point() const { return bsdf.point(); }
  Vec3 operator()(Vec3 wi) const { return bsdf.eval(group, wi); }
};
struct ByBsdfAndPart {
  using Light = LightWithPart;
  const Bsdf& bsdf;
  LobeGroup group;
  Vec3 matt;
  const SurfacePoint& point() const { return bsdf.point(); }
  LightWithPart operator()(Vec3 wi) const {
    return {bsdf.eval(group, wi), matt * diffuseCosine(bsdf.point(), wi)};
  }
};

template <typename Reflects>
bool unoccluded(const LightSet& lights, const Reflects& reflects, const LightPlace& place,
                DirectSample& out, typename Reflects::Light& reflected) {
  if (!lights.sampleDirect(place.light, reflects.point().position, place.at.x, place.at.y, out))
    return false;
  reflected = reflects(out.wi) * out.radianceOverPdf;
  return !isBlack(reflected);
}

// One shadow ray towards a point of a light; its share where that gets `count` in the mean, and
// rays are sent besides with density rayPdf(wi), or none where `shared` is false.
template <typename Reflects, typename RayPdf>
typename Reflects::Light sampleLight(const RayScene& rays, const LightSet& lights,
                                     const Reflects& reflects, const LightPlace& place, float count,
                                     bool shared, const RayPdf& rayPdf,
                                     const SharedWithPhotons& photons = {}) {
  DirectSample s;
  typename Reflects::Light reflected;
  if (!unoccluded(lights, reflects, place, s, reflected)) return {};
  if (isHidden(rays, reflects.point(), s)) return {};
  const bool mis = shared && s.pdf > 0.0f;
  return reflected * ((mis ? powerHeuristic(s.pdf * count, rayPdf(s.wi)) : 1.0f) *
                      photons.ofRays(place.light, s.wi) / count);
}

// One of the rays by what was learned, by a point of the unit square.
template <typename Reflects, typename RayPdf>
typename Reflects::Light sampleStratum(const RayScene& rays, const LightSet& lights,
                                       const Reflects& reflects, const LearnedLight& learned,
                                       Point2 at, bool shared, const RayPdf& rayPdf,
                                       const SharedWithPhotons& photons = {}) {
  const LearnedStrata& strata = *learned.strata;
  const uint32_t stratum = strata.pick(at.x);
  const LightPlace place = strata.all->place(stratum, at);
  const float count = static_cast<float>(learned.rays) * strata.probability(stratum) /
                      strata.all->share(stratum) * strata.all->lightShare(place.light);
  return sampleLight(rays, lights, reflects, place, count, shared, rayPdf, photons);
}

template <typename Reflects, typename RayPdf>
typename Reflects::Light sampleOne(const RayScene& rays, const LightSet& lights,
                                   const Reflects& reflects, const LearnedStrata& strata,
                                   bool shared, const RayPdf& rayPdf, Rng& rng,
                                   const SharedWithPhotons& photons = {}) {
  if (strata.all) {
    return sampleStratum(rays, lights, reflects, {&strata, 1}, rng.nextPoint(), shared, rayPdf,
                         photons);
  }
  if (lights.size() == 0) return {};
  float probability = 1.0f;
  const size_t light = lights.pick(rng.next(), probability);
  if (!(probability > 0.0f)) return {};
  return sampleLight(rays, lights, reflects, {static_cast<uint32_t>(light), rng.nextPoint()},
                     probability, shared, rayPdf, photons);
}

// All rays by what was learned, points of a sequence.
template <typename Reflects, typename RayPdf>
typename Reflects::Light sampleStrata(const RayScene& rays, const LightSet& lights,
                                      const Reflects& reflects, const LearnedLight& learned,
                                      bool shared, const RayPdf& rayPdf, uint32_t firstPoint,
                                      uint64_t key) {
  typename Reflects::Light sum;
  for (unsigned k = 0; k < learned.rays; ++k) {
    sum += sampleStratum(rays, lights, reflects, learned, owenSobol(firstPoint + k, key), shared,
                         rayPdf);
  }
  return sum;
}

// The same, or one ray where nothing was learned, beside a ray with that density.
template <typename Reflects>
typename Reflects::Light besideRay(const RayScene& rays, const LightSet& lights,
                                   const Reflects& reflects, const LearnedLight& learned,
                                   const std::function<float(Vec3)>& rayPdf, Rng& rng) {
  if (!learned.strata) return sampleOne(rays, lights, reflects, LearnedStrata{}, true, rayPdf, rng);
  const uint64_t key = mix64(static_cast<uint64_t>(rng.next() * 0x1p24f));
  return sampleStrata(rays, lights, reflects, learned, true, rayPdf, 0, key);
}

}  // namespace

uint64_t lampOf(const LightSet& lights, size_t light, Vec3 towards) {
  const float density = lights.photonDensity(light, towards);
  const int step = density > 0.0f && std::isfinite(density) ? (std::ilogb(density) + 512) / 2 : 0;
  return uint64_t{light} << 9 | static_cast<uint64_t>(step);
}

float SharedWithPhotons::ofRays(size_t light, Vec3 towards) const {
  const float sent = lights ? photons * lights->pickProbability(light) : 0.0f;
  if (!(sent > 0.0f)) return 1.0f;
  if (!lights->hittable(light)) return 0.0f;
  if (lamps && !std::ranges::binary_search(*lamps, lampOf(*lights, light, towards))) return 1.0f;
  return powerHeuristic(rays, sent * lights->photonDensity(light, towards));
}

Vec3 directLight(const RayScene& rays, const LightSet& lights, const Bsdf& bsdf, LobeGroup group,
                 LightChoice choice, float bsdfRays, Rng& rng, const SharedWithPhotons& shared) {
  Vec3 sum;
  const auto rayPdf = raysByBsdf(bsdf, group, bsdfRays);
  const bool all = choice == LightChoice::Each && lights.size() <= kMaxLightsEach;
  const size_t count = all ? lights.size() : choice == LightChoice::Each ? kMaxLightsEach : 1;
  for (size_t k = 0; k < count && lights.size() > 0; ++k) {
    float probability = 1.0f;
    const size_t light = all ? k : lights.pick(rng.next(), probability);
    if (!(probability > 0.0f)) continue;
    sum += sampleLight(rays, lights, ByBsdf{bsdf, group},
                       {static_cast<uint32_t>(light), rng.nextPoint()},
                       raysTo(lights, light, choice), bsdfRays > 0, rayPdf, shared);
  }
  return sum;
}

Vec3 directLight(const RayScene& rays, const LightSet& lights, const Bsdf& bsdf, LobeGroup group,
                 const LearnedLight& learned, float bsdfRays, uint32_t firstPoint, uint64_t key) {
  return sampleStrata(rays, lights, ByBsdf{bsdf, group}, learned, bsdfRays > 0,
                      raysByBsdf(bsdf, group, bsdfRays), firstPoint, key);
}

Vec3 directLight(const RayScene& rays, const LightSet& lights, const Bsdf& bsdf, LobeGroup group,
                 const LearnedLight& learned, const std::function<float(Vec3)>& rayPdf,
                 uint32_t firstPoint, uint64_t key) {
  return sampleStrata(rays, lights, ByBsdf{bsdf, group}, learned, true, rayPdf, firstPoint, key);
}

Vec3 directLight(const RayScene& rays, const LightSet& lights, const Bsdf& bsdf, LobeGroup group,
                 const LearnedStrata& strata, float bsdfRays, Rng& rng,
                 const SharedWithPhotons& shared) {
  return sampleOne(rays, lights, ByBsdf{bsdf, group}, strata, bsdfRays > 0,
                   raysByBsdf(bsdf, group, bsdfRays), rng, shared);
}

Vec3 directLight(const RayScene& rays, const LightSet& lights, const Bsdf& bsdf, LobeGroup group,
                 const LearnedLight& learned, const std::function<float(Vec3)>& rayPdf, Rng& rng) {
  return besideRay(rays, lights, ByBsdf{bsdf, group}, learned, rayPdf, rng);
}

LightWithPart directLight(const RayScene& rays, const LightSet& lights, const Bsdf& bsdf,
                          LobeGroup group, Vec3 matt, const LearnedLight& learned,
                          const std::function<float(Vec3)>& rayPdf, Rng& rng) {
  return besideRay(rays, lights, ByBsdfAndPart{bsdf, group, matt}, learned, rayPdf, rng);
}

bool unoccludedLight(const LightSet& lights, const Bsdf& bsdf, LobeGroup group,
                     const LightPlace& place, DirectSample& out, Vec3& reflected) {
  return unoccluded(lights, ByBsdf{bsdf, group}, place, out, reflected);
}

bool isHidden(const RayScene& rays, const SurfacePoint& at, const DirectSample& s) {
  const Vec3 side = dot(at.ng, s.wi) < 0.0f ? -at.ng : at.ng;  // the light may shine through
  const Vec3 from = rays.offsetOrigin(at.position, side);
  return s.infinite ? rays.occludedToInfinity(from, s.wi) : rays.occluded(from, s.target);
}

Vec3 emissionMet(const LightSet& lights, const SurfacePoint& hit, const Arrival& arrival) {
  size_t light = kNone;
  const Vec3 emitted = lights.emitted(hit, light);
  if (isBlack(emitted)) return {};
  return emitted * arrival.shared.ofRays(light, {}) *
         hitWeight(lights, light, lights.pdfEmitted(light, hit, arrival.from), arrival,
                   [&] { return lights.drawnBy(light, hit); });
}

Vec3 emissionAtInfinity(const LightSet& lights, Vec3 direction, const Arrival& arrival) {
  Vec3 sum;
  lights.forEachAtInfinity(direction, [&](size_t light, Vec3 radiance, float pdf) {
    sum += radiance * arrival.shared.ofRays(light, direction) *
           hitWeight(lights, light, pdf, arrival, [&] { return lights.drawnBy(light, direction); });
  });
  return sum;
}

}  // namespace bnvpl
