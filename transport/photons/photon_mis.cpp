#include "transport/photons/photon_mis.h"

#include <cmath>

#include "core/sampling.h"
#include "transport/walk.h"

namespace bnvpl {

uint64_t emitterOf(const LightSet& lights, size_t light, Vec3 towards) {
  const float density = lights.photonDensity(light, towards);
  const int step = density > 0.0f && std::isfinite(density) ? (std::ilogb(density) + 512) / 2 : 0;
  return uint64_t{light} << 9 | static_cast<uint64_t>(step);
}

bool PhotonMis::sends(size_t light, Vec3 towards) const {
  if (!lights || !(photons * lights->pickProbability(light) > 0.0f)) return false;
  return !emitters || !lights->hittable(light) ||
         std::ranges::binary_search(*emitters, emitterOf(*lights, light, towards));
}

float PhotonMis::sharedSpecularProbability(const Bsdf& vertex, float roughImportance) {
  return vertex.transmits() ? 1.0f : specularProbability(vertex, roughImportance);
}

float PhotonMis::shadowRayRatio(float shadowRays, float bsdfRays) {
  constexpr float kMaxRatio = 1e6f;
  return shadowRays < kMaxRatio * bsdfRays ? shadowRays / bsdfRays
         : shadowRays > 0.0f               ? kMaxRatio
                                           : 0.0f;
}

PhotonMis PhotonMis::beyond(const Bsdf& vertex, bool first) const {
  PhotonMis out = *this;
  out.rays *= sharedSpecularProbability(vertex, first ? roughImportance : 1.0f);
  out.countsShadowRays = !vertex.transmits() && !vertex.specularIsDelta();
  return out;
}

float PhotonMis::rayWeight(size_t light, Vec3 towards, float guided, float shadowRays) const {
  if (!sends(light, towards)) return 1.0f;
  if (misRatio > 0.0f) return misRatio / (guided + misRatio);
  if (!lights->hittable(light)) return 0.0f;
  return powerHeuristic(
      rays * std::sqrt(1.0f + shadowRays * shadowRays),
      photons * lights->pickProbability(light) * guided * lights->photonDensity(light, towards));
}

}  // namespace bnvpl
