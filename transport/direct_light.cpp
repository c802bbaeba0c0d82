#include "transport/direct_light.h"

#include <algorithm>
#include <cmath>

#include "core/sampling.h"

namespace bnvpl {

namespace {

// MIS weight of emission that a BSDF ray hit, against light sampling. place() gives the point of
// the light's unit square that it hit.
template <typename Place>
float hitWeight(const LightSet& lights, size_t light, float lightPdf, const Arrival& arrival,
                const Place& place) {
  if (!(arrival.bsdfPdf > 0.0f)) return 1.0f;
  const LearnedLight& learned = arrival.learned;
  const float rays = learned.strata
                         ? static_cast<float>(learned.rays) *
                               learned.strata->density({static_cast<uint32_t>(light), place()})
                         : shadowRaysTo(lights, light, arrival.choice);
  return powerHeuristic(arrival.bsdfPdf, lightPdf * rays);
}

}  // namespace

float shadowRaysTo(const LightSet& lights, size_t light, LightChoice choice) {
  if (choice == LightChoice::One) return lights.pickProbability(light);
  if (lights.size() <= kMaxLightsEach) return 1.0f;
  return static_cast<float>(kMaxLightsEach) * lights.pickProbability(light);
}

uint64_t emitterOf(const LightSet& lights, size_t light, Vec3 towards) {
  const float density = lights.photonDensity(light, towards);
  const int step = density > 0.0f && std::isfinite(density) ? (std::ilogb(density) + 512) / 2 : 0;
  return uint64_t{light} << 9 | static_cast<uint64_t>(step);
}

bool PhotonMis::sends(size_t light, Vec3 towards) const {
  if (!lights || !(photons * lights->pickProbability(light) > 0.0f)) return false;
  return !lamps || !lights->hittable(light) ||
         std::ranges::binary_search(*lamps, emitterOf(*lights, light, towards));
}

float PhotonMis::rayWeight(size_t light, Vec3 towards, float guided) const {
  if (!sends(light, towards)) return 1.0f;
  if (emissionBalance > 0.0f) return emissionBalance / (guided + emissionBalance);
  if (!lights->hittable(light)) return 0.0f;
  return powerHeuristic(rays, photons * lights->pickProbability(light) * guided *
                                  lights->photonDensity(light, towards));
}

bool isHidden(const Accelerator& accel, const SurfacePoint& at, const LightSample& s) {
  const Vec3 side = dot(at.ng, s.wi) < 0.0f ? -at.ng : at.ng;  // the light may shine through
  const Vec3 from = accel.offsetOrigin(at.position, side);
  return s.infinite ? accel.occludedToInfinity(from, s.wi) : accel.occluded(from, s.target);
}

Vec3 emissionHit(const LightSet& lights, const SurfacePoint& hit, const Arrival& arrival) {
  size_t light = kNone;
  const Vec3 emitted = lights.emitted(hit, light);
  if (isBlack(emitted)) return {};
  const auto place = [&] { return lights.invertSample(light, hit); };
  const float rayWeight = arrival.photons.rayWeight(light, -hit.wo, arrival.from, place);
  const float pdf = lights.pdfDirect(light, hit, arrival.from);
  const Vec3 found = emitted * rayWeight * hitWeight(lights, light, pdf, arrival, place);
  if (arrival.groups) arrival.groups.add(lights.group(light), found);
  return found;
}

Vec3 emissionAtInfinity(const LightSet& lights, Vec3 direction, const Arrival& arrival) {
  Vec3 sum;
  lights.forEachAtInfinity(direction, [&](size_t light, Vec3 radiance, float pdf) {
    const auto place = [&] { return lights.invertSample(light, direction); };
    const float rayWeight = arrival.photons.rayWeight(light, direction, arrival.from, place);
    const Vec3 found = radiance * rayWeight * hitWeight(lights, light, pdf, arrival, place);
    sum += found;
    if (arrival.groups) arrival.groups.add(lights.group(light), found);
  });
  return sum;
}

}  // namespace bnvpl
