#include "transport/direct_light/direct_light.h"

#include <algorithm>
#include <cmath>

#include "core/sampling.h"

namespace bnvpl {

namespace {

// MIS weight of emission that a BSDF ray hit, against light sampling and photons. place() gives the
// point of the light's unit square that it hit.
template <typename Place>
float hitWeight(const LightSet& lights, size_t light, float lightPdf, Vec3 towards,
                const Arrival& arrival, const Place& place) {
  const auto photons = [&](float shadowRays) {
    return arrival.photons.rayWeight(light, towards, arrival.from, place, shadowRays);
  };
  if (!(arrival.bsdfPdf > 0.0f)) return photons(0.0f);
  const LearnedLight& learned = arrival.learned;
  const float rays = learned.strata
                         ? static_cast<float>(learned.rays) *
                               learned.strata->density({static_cast<uint32_t>(light), place()})
                         : shadowRaysTo(lights, light, arrival.choice);
  return powerHeuristic(arrival.bsdfPdf, lightPdf * rays) *
         photons(PhotonMis::shadowRayRatio(lightPdf * rays, arrival.bsdfPdf));
}

}  // namespace

float shadowRaysTo(const LightSet& lights, size_t light, LightChoice choice) {
  if (choice == LightChoice::One) return lights.pickProbability(light);
  if (lights.size() <= kMaxLightsEach) return 1.0f;
  return static_cast<float>(kMaxLightsEach) * lights.pickProbability(light);
}

bool occluded(const Accelerator& accel, const SurfacePoint& at, const LightSample& s) {
  const Vec3 side = dot(at.ng, s.wi) < 0.0f ? -at.ng : at.ng;  // the light may shine through
  const Vec3 from = accel.offsetOrigin(at.position, side);
  return s.infinite ? accel.occludedToInfinity(from, s.wi) : accel.occluded(from, s.target);
}

Vec3 emissionHit(const LightSet& lights, const SurfacePoint& hit, const Arrival& arrival) {
  size_t light = kNone;
  const Vec3 emitted = lights.emitted(hit, light);
  if (isBlack(emitted)) return {};
  const auto place = [&] { return lights.invertSample(light, hit); };
  const float pdf = lights.pdfDirect(light, hit, arrival.from);
  const Vec3 found = emitted * hitWeight(lights, light, pdf, -hit.wo, arrival, place);
  if (arrival.groups) arrival.groups.add(lights.group(light), found);
  return found;
}

Vec3 emissionAtInfinity(const LightSet& lights, Vec3 direction, const Arrival& arrival) {
  Vec3 sum;
  lights.forEachAtInfinity(direction, [&](size_t light, Vec3 radiance, float pdf) {
    const auto place = [&] { return lights.invertSample(light, direction); };
    const Vec3 found = radiance * hitWeight(lights, light, pdf, direction, arrival, place);
    sum += found;
    if (arrival.groups) arrival.groups.add(lights.group(light), found);
  });
  return sum;
}

}  // namespace bnvpl
