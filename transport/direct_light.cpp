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

// One shadow ray towards one light; its share where the light gets `count` in the mean, and rays
// are sent besides with density rayPdf(wi), or none where `shared` is false.
template <typename RayPdf>
Vec3 sampleLight(const RayScene& rays, const LightSet& lights, const Bsdf& bsdf, LobeGroup group,
                 size_t light, float count, bool shared, const RayPdf& rayPdf, Rng& rng) {
  const SurfacePoint& at = bsdf.point();
  const float u = rng.next(), v = rng.next();
  DirectSample s;
  if (!lights.sampleDirect(light, at.position, u, v, s)) return {};
  const Vec3 reflected = bsdf.eval(group, s.wi) * s.radianceOverPdf;
  if (isBlack(reflected)) return {};
  const Vec3 side = dot(at.ng, s.wi) < 0.0f ? -at.ng : at.ng;  // the light may shine through
  const Vec3 from = rays.offsetOrigin(at.position, side);
  if (s.infinite ? rays.occludedToInfinity(from, s.wi) : rays.occluded(from, s.target)) return {};
  const bool mis = shared && s.pdf > 0.0f;
  return reflected * ((mis ? powerHeuristic(s.pdf * count, rayPdf(s.wi)) : 1.0f) / count);
}

}  // namespace

Vec3 directLight(const RayScene& rays, const LightSet& lights, const Bsdf& bsdf, LobeGroup group,
                 LightChoice choice, unsigned bsdfRays, Rng& rng) {
  Vec3 sum;
  const auto rayPdf = [&](Vec3 wi) { return static_cast<float>(bsdfRays) * bsdf.pdf(group, wi); };
  const bool all = choice == LightChoice::Each && lights.size() <= kMaxLightsEach;
  const size_t count = all ? lights.size() : choice == LightChoice::Each ? kMaxLightsEach : 1;
  for (size_t k = 0; k < count && lights.size() > 0; ++k) {
    float probability = 1.0f;
    const size_t light = all ? k : lights.pick(rng.next(), probability);
    if (!(probability > 0.0f)) continue;
    sum += sampleLight(rays, lights, bsdf, group, light, raysTo(lights, light, choice),
                       bsdfRays > 0, rayPdf, rng);
  }
  return sum;
}

Vec3 directLight(const RayScene& rays, const LightSet& lights, const Bsdf& bsdf, LobeGroup group,
                 const std::function<float(Vec3)>& rayPdf, Rng& rng) {
  if (lights.size() == 0) return {};
  float probability = 1.0f;
  const size_t light = lights.pick(rng.next(), probability);
  if (!(probability > 0.0f)) return {};
  return sampleLight(rays, lights, bsdf, group, light, probability, true, rayPdf, rng);
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
