// The walk of one photon, shared by every stage that follows light from its source.
#pragma once

#include "core/random.h"
#include "scene/bsdf.h"
#include "scene/lights.h"

namespace bnvpl {

inline constexpr unsigned kMaxChain = 64;  // specular scatterings between two rough ones

// Where a photon's flux went, W.
struct PhotonFate {
  Vec3 escaped;
  Vec3 absorbed;  // by surfaces, and at the end of the longest path
  uint32_t hits = 0, rays = 0;
  bool finite = true;  // false: its flux became NaN or infinite and what was left was dropped
};

// Follows a photon through the scene. At each hit with rough lobes, visit(bsdf, flux, straight)
// gets the flux that arrives (before albedo), shading normals accounted for, and whether nothing
// was between the light and the hit; at most maxBounces times, counting the rough scatterings so
// far plus this one. Russian roulette by reflectance keeps the flux about level.
template <typename Visit>
PhotonFate tracePhoton(const RayScene& rays, const PhotonStart& start, unsigned maxBounces,
                       Rng& rng, const Visit& visit) {
  PhotonFate fate;
  Vec3 origin = start.origin, direction = start.direction, flux = start.flux;
  unsigned rough = 0, chain = 0;
  SurfacePoint hit;
  if (!isFinite(flux)) {
    fate.finite = false;
    return fate;
  }
  while (true) {
    ++fate.rays;
    if (!rays.closestHit(origin, direction, hit)) {
      fate.escaped += flux;
      return fate;
    }
    const Bsdf bsdf(rays.scene(), hit);
    // What does not travel on counts as absorbed, roulette included: escaped + absorbed = emitted
    // exactly.
    fate.absorbed += flux;
    if (bsdf.hasRough()) {
      const Vec3 arriving = flux * bsdf.photonShadingFactor();
      if (!isFinite(arriving)) {
        fate.finite = false;
        return fate;
      }
      ++fate.hits;
      visit(bsdf, arriving, rough + chain == 0);
    }
    const float survive = bsdf.reflectance();
    if (rng.next() >= survive) return fate;
    const float chainProbability = bsdf.chainProbability();
    const bool takeChain = rng.next() < chainProbability;
    const float probability = takeChain ? chainProbability : 1.0f - chainProbability;
    BsdfSample next;
    const bool last = takeChain ? ++chain > kMaxChain : ++rough >= maxBounces;
    if (last || !bsdf.sample(takeChain ? LobeGroup::Chain : LobeGroup::Rough, Transport::Photons,
                             rng, next)) {
      return fate;
    }
    const Vec3 onward = flux * next.weight * (1.0f / (probability * survive));
    if (!isFinite(onward)) {
      fate.finite = false;
      return fate;
    }
    flux = onward;
    fate.absorbed += -flux;
    origin = rays.lifted(hit.position, next.side);
    direction = next.wi;
  }
}

}  // namespace bnvpl
