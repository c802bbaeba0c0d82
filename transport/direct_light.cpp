#include "transport/direct_light.h"

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
auto raysByBsdf(const Bsdf& bsdf, LobeGroup group, unsigned rays) {
  return [&bsdf, group, rays](Vec3 wi) { return static_cast<float>(rays) * bsdf.pdf(group, wi); };
}

// One shadow ray towards a point of a light; its share where that gets `count` in the mean, and
// rays are sent besides with density rayPdf(wi), or none where `shared` is false.
template <typename RayPdf>
Vec3 sampleLight(const RayScene& rays, const LightSet& lights, const Bsdf& bsdf, LobeGroup group,
                 const LightPlace& place, float count, bool shared, const RayPdf& rayPdf,
                 const SharedWithPhotons& photons = {}) {
  DirectSample s;
  Vec3 reflected;
  if (!unoccludedLight(lights, bsdf, group, place, s, reflected)) return {};
  if (isHidden(rays, bsdf.point(), s)) return {};
  const bool mis = shared && s.pdf > 0.0f;
  return reflected * ((mis ? powerHeuristic(s.pdf * count, rayPdf(s.wi)) : 1.0f) *
                      photons.ofRays(place.light, s.wi) / count);
}

// One of the rays by what was learned, by a point of the unit square.
template <typename RayPdf>
Vec3 sampleStratum(const RayScene& rays, const LightSet& lights, const Bsdf& bsdf, LobeGroup group,
                   const LearnedLight& learned, Point2 at, bool shared, const RayPdf& rayPdf,
                   const SharedWithPhotons& photons = {}) {
  const LearnedStrata& strata = *learned.strata;
  const uint32_t stratum = strata.pick(at.x);
  const LightPlace place = strata.all->place(stratum, at);
  const float count = static_cast<float>(learned.rays) * strata.probability(stratum) /
                      strata.all->share(stratum) * strata.all->lightShare(place.light);
  return sampleLight(rays, lights, bsdf, group, place, count, shared, rayPdf, photons);
}

template <typename RayPdf>
Vec3 sampleOne(const RayScene& rays, const LightSet& lights, const Bsdf& bsdf, LobeGroup group,
               const LearnedStrata& strata, bool shared, const RayPdf& rayPdf, Rng& rng,
               const SharedWithPhotons& photons = {}) {
  if (strata.all) {
    const float u = rng.next(), v = rng.next();
    return sampleStratum(rays, lights, bsdf, group, {&strata, 1}, {u, v}, shared, rayPdf, photons);
  }
  if (lights.size() == 0) return {};
  float probability = 1.0f;
  const size_t light = lights.pick(rng.next(), probability);
  if (!(probability > 0.0f)) return {};
  const float u = rng.next(), v = rng.next();
  return sampleLight(rays, lights, bsdf, group, {static_cast<uint32_t>(light), {u, v}}, probability,
                     shared, rayPdf, photons);
}

}  // namespace

float SharedWithPhotons::ofRays(size_t light, Vec3 towards) const {
  const float sent = lights ? photons * lights->pickProbability(light) : 0.0f;
  if (!(sent > 0.0f)) return 1.0f;
  if (!lights->hittable(light)) return 0.0f;
  return powerHeuristic(rays, sent * lights->photonDensity(light, towards));
}

Vec3 directLight(const RayScene& rays, const LightSet& lights, const Bsdf& bsdf, LobeGroup group,
                 LightChoice choice, unsigned bsdfRays, Rng& rng, const SharedWithPhotons& shared) {
  Vec3 sum;
  const auto rayPdf = raysByBsdf(bsdf, group, bsdfRays);
  const bool all = choice == LightChoice::Each && lights.size() <= kMaxLightsEach;
  const size_t count = all ? lights.size() : choice == LightChoice::Each ? kMaxLightsEach : 1;
  for (size_t k = 0; k < count && lights.size() > 0; ++k) {
    float probability = 1.0f;
    const size_t light = all ? k : lights.pick(rng.next(), probability);
    if (!(probability > 0.0f)) continue;
    const float u = rng.next(), v = rng.next();
    sum += sampleLight(rays, lights, bsdf, group, {static_cast<uint32_t>(light), {u, v}},
                       raysTo(lights, light, choice), bsdfRays > 0, rayPdf, shared);
  }
  return sum;
}

Vec3 directLight(const RayScene& rays, const LightSet& lights, const Bsdf& bsdf, LobeGroup group,
                 const LearnedLight& learned, unsigned bsdfRays, uint32_t firstPoint,
                 uint64_t key) {
  const auto rayPdf = raysByBsdf(bsdf, group, bsdfRays);
  Vec3 sum;
  for (unsigned k = 0; k < learned.rays; ++k) {
    sum += sampleStratum(rays, lights, bsdf, group, learned, owenSobol(firstPoint + k, key),
                         bsdfRays > 0, rayPdf);
  }
  return sum;
}

Vec3 directLight(const RayScene& rays, const LightSet& lights, const Bsdf& bsdf, LobeGroup group,
                 const LearnedStrata& strata, unsigned bsdfRays, Rng& rng,
                 const SharedWithPhotons& shared) {
  return sampleOne(rays, lights, bsdf, group, strata, bsdfRays > 0,
                   raysByBsdf(bsdf, group, bsdfRays), rng, shared);
}

Vec3 directLight(const RayScene& rays, const LightSet& lights, const Bsdf& bsdf, LobeGroup group,
                 const LearnedStrata& strata, const std::function<float(Vec3)>& rayPdf, Rng& rng) {
  return sampleOne(rays, lights, bsdf, group, strata, true, rayPdf, rng);
}

bool unoccludedLight(const LightSet& lights, const Bsdf& bsdf, LobeGroup group,
                     const LightPlace& place, DirectSample& out, Vec3& reflected) {
  if (!lights.sampleDirect(place.light, bsdf.point().position, place.at.x, place.at.y, out))
    return false;
  reflected = bsdf.eval(group, out.wi) * out.radianceOverPdf;
  return !isBlack(reflected);
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
