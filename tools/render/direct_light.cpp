#include "tools/render/direct_light.h"

#include "core/sampling.h"

namespace bnvpl {

namespace {

// Share of a hit found by the BSDF, against light sampling that picks one light.
float hitWeight(const Arrival& arrival, float lightPdf) {
  return arrival.bsdfPdf > 0.0f ? powerHeuristic(arrival.bsdfPdf, lightPdf) : 1.0f;
}

}  // namespace

Vec3 sampleLight(const RayScene& rays, const LightSet& lights, const Bsdf& bsdf, LobeGroup group,
                 size_t light, float lightProbability, bool mis, Rng& rng) {
  const SurfacePoint& at = bsdf.point();
  const float u = rng.next(), v = rng.next();
  DirectSample s;
  if (!lights.sampleDirect(light, at.position, u, v, s)) return {};
  const Vec3 reflected = bsdf.eval(group, s.wi) * s.radianceOverPdf;
  if (isBlack(reflected)) return {};
  const Vec3 from = rays.lifted(at.position, at.ng);
  if (s.infinite ? rays.occludedToInfinity(from, s.wi) : rays.occluded(from, s.target)) return {};
  const float weight =
      mis && s.pdf > 0.0f ? powerHeuristic(s.pdf * lightProbability, bsdf.pdf(group, s.wi)) : 1.0f;
  return reflected * (weight / lightProbability);
}

Vec3 directLight(const RayScene& rays, const LightSet& lights, const Bsdf& bsdf, LobeGroup group,
                 Rng& rng) {
  Vec3 sum;
  if (lights.size() <= kMaxLightsEach) {
    for (size_t l = 0; l < lights.size(); ++l)
      sum += sampleLight(rays, lights, bsdf, group, l, 1.0f, false, rng);
    return sum;
  }
  for (size_t k = 0; k < kMaxLightsEach; ++k) {
    float probability = 0.0f;
    const size_t l = lights.pick(rng.next(), probability);
    sum += sampleLight(rays, lights, bsdf, group, l, probability, false, rng);
  }
  return sum * (1.0f / static_cast<float>(kMaxLightsEach));
}

Vec3 directLightMis(const RayScene& rays, const LightSet& lights, const Bsdf& bsdf, LobeGroup group,
                    Rng& rng) {
  if (lights.size() == 0) return {};
  float probability = 0.0f;
  const size_t l = lights.pick(rng.next(), probability);
  if (!(probability > 0.0f)) return {};
  return sampleLight(rays, lights, bsdf, group, l, probability, true, rng);
}

Vec3 emissionMet(const LightSet& lights, const SurfacePoint& hit, const Arrival& arrival) {
  size_t light = kNone;
  const Vec3 emitted = lights.emitted(hit, light);
  if (isBlack(emitted)) return {};
  return emitted * hitWeight(arrival, lights.pickProbability(light) *
                                          lights.pdfEmitted(light, hit, arrival.from));
}

Vec3 emissionAtInfinity(const LightSet& lights, Vec3 direction, const Arrival& arrival) {
  Vec3 sum;
  lights.forEachAtInfinity(direction, [&](size_t light, Vec3 radiance, float pdf) {
    sum += radiance * hitWeight(arrival, lights.pickProbability(light) * pdf);
  });
  return sum;
}

}  // namespace bnvpl
