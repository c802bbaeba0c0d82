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

// Share of a hit found by the BSDF, against light sampling.
float hitWeight(const LightSet& lights, size_t light, float lightPdf, const Arrival& arrival) {
  if (!(arrival.bsdfPdf > 0.0f)) return 1.0f;
  return powerHeuristic(arrival.bsdfPdf, lightPdf * raysTo(lights, light, arrival.choice));
}

// One shadow ray towards one light; its share where the light gets `count` in the mean.
Vec3 sampleLight(const RayScene& rays, const LightSet& lights, const Bsdf& bsdf, LobeGroup group,
                 size_t light, float count, unsigned bsdfRays, Rng& rng) {
  const SurfacePoint& at = bsdf.point();
  const float u = rng.next(), v = rng.next();
  DirectSample s;
  if (!lights.sampleDirect(light, at.position, u, v, s)) return {};
  const Vec3 reflected = bsdf.eval(group, s.wi) * s.radianceOverPdf;
  if (isBlack(reflected)) return {};
  const Vec3 side = dot(at.ng, s.wi) < 0.0f ? -at.ng : at.ng;  // the light may shine through
  const Vec3 from = rays.offsetOrigin(at.position, side);
  if (s.infinite ? rays.occludedToInfinity(from, s.wi) : rays.occluded(from, s.target)) return {};
  const bool mis = bsdfRays > 0 && s.pdf > 0.0f;
  const float bsdfPdf = mis ? static_cast<float>(bsdfRays) * bsdf.pdf(group, s.wi) : 0.0f;
  return reflected * ((mis ? powerHeuristic(s.pdf * count, bsdfPdf) : 1.0f) / count);
}

}  // namespace

Vec3 directLight(const RayScene& rays, const LightSet& lights, const Bsdf& bsdf, LobeGroup group,
                 LightChoice choice, unsigned bsdfRays, Rng& rng) {
  Vec3 sum;
  const bool all = choice == LightChoice::Each && lights.size() <= kMaxLightsEach;
  const size_t count = all ? lights.size() : choice == LightChoice::Each ? kMaxLightsEach : 1;
  for (size_t k = 0; k < count && lights.size() > 0; ++k) {
    float probability = 1.0f;
    const size_t light = all ? k : lights.pick(rng.next(), probability);
    if (!(probability > 0.0f)) continue;
    sum +=
        sampleLight(rays, lights, bsdf, group, light, raysTo(lights, light, choice), bsdfRays, rng);
  }
  return sum;
}

Vec3 emissionMet(const LightSet& lights, const SurfacePoint& hit, const Arrival& arrival) {
  size_t light = kNone;
  const Vec3 emitted = lights.emitted(hit, light);
  if (isBlack(emitted)) return {};
  return emitted * hitWeight(lights, light, lights.pdfEmitted(light, hit, arrival.from), arrival);
}

Vec3 emissionAtInfinity(const LightSet& lights, Vec3 direction, const Arrival& arrival) {
  Vec3 sum;
  lights.forEachAtInfinity(direction, [&](size_t light, Vec3 radiance, float pdf) {
    sum += radiance * hitWeight(lights, light, pdf, arrival);
  });
  return sum;
}

}  // namespace bnvpl
