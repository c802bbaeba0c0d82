// The random walk of one photon, for every stage that traces light from its source.
#pragma once

#include "core/random.h"
#include "transport/lights/lights.h"
#include "transport/walk.h"

namespace bnvpl {

// Where a photon's flux went, W.
struct PhotonFate {
  Vec3 escaped;
  Vec3 absorbed;  // by surfaces, by Russian roulette and by the path's end
  uint32_t rays = 0;
  bool finite = true;  // false: the flux became NaN or infinite, and the photon was dropped
};

// The state of a photon between two hits.
class PhotonWalk {
 public:
  PhotonWalk() = default;
  // `rng` continues the numbers from which `start` was sampled.
  PhotonWalk(const PhotonStart& start, unsigned maxBounces, const Rng& rng)
      : rng_(rng),
        next_{start.origin, start.direction},
        flux_(start.flux),
        maxBounces_(maxBounces),
        goesOn_(isFinite(start.flux) && !isBlack(start.flux)) {
    fate_.finite = isFinite(start.flux);
  }

  bool goesOn() const { return goesOn_; }
  const Ray& next() const { return next_; }  // the ray to trace, if goesOn()
  const PhotonFate& fate() const { return fate_; }
  // Whether its first scattering was by a delta lobe. If no ray can hit the light, no path from the
  // camera finds this contribution.
  bool firstScatteringIsDelta() const { return firstScatteringIsDelta_; }
  Rng& rng() { return rng_; }
  // One of several photons that replace this one, each with a share of its flux. The fate of each
  // includes the path so far.
  PhotonWalk branch(float share, const Rng& rng) const {
    PhotonWalk b = *this;
    b.rng_ = rng;
    b.flux_ *= share;
    return b;
  }

  // Scatters the photon at the hit of next(); hit.triangle is kNone where it left the scene. Where
  // the hit has rough lobes, calls visit(bsdf, flux, firstBounce) with the arriving flux (before
  // the albedo, with the shading factor) and whether it came straight from the light. The walk ends
  // at the maxBounces-th rough scattering. Russian roulette by reflectance keeps the flux nearly
  // constant.
  template <typename Visit>
  void advance(const Accelerator& accel, const SurfacePoint& hit, const Visit& visit) {
    ++fate_.rays;
    goesOn_ = false;
    if (hit.triangle == kNone) {
      fate_.escaped += flux_;
      return;
    }
    const Bsdf bsdf(accel.scene(), hit);
    // Flux that does not continue counts as absorbed, Russian roulette included, so that escaped +
    // absorbed equals the emitted flux.
    fate_.absorbed += flux_;
    if (bsdf.hasRough()) {
      const Vec3 arriving = flux_ * bsdf.photonShadingFactor();
      if (!isFinite(arriving)) {
        fate_.finite = false;
        return;
      }
      visit(bsdf, arriving, rough_ + specular_ == 0);
    }
    const float survive = bsdf.survivalProbability();
    if (rng_.next() >= survive) return;
    const LobeChoice lobes = chooseLobes(bsdf, rng_);
    const bool first = rough_ + specular_ == 0;
    const bool last = lobes.specular() ? ++specular_ > kMaxSpecular : ++rough_ >= maxBounces_;
    if (!lobes.specular()) specular_ = 0;  // the limit is that between two rough vertices
    BsdfSample sample;
    Ray next;
    if (last ||
        !sampleNextRay(accel, bsdf, lobes.group, TransportMode::Importance, rng_, sample, next))
      return;
    if (first) firstScatteringIsDelta_ = lobes.specular() && sample.pdf == 0.0f;
    const Vec3 onward = flux_ * sample.weight * (1.0f / (lobes.probability * survive));
    if (!isFinite(onward)) {
      fate_.finite = false;
      return;
    }
    flux_ = onward;
    fate_.absorbed += -flux_;
    next_ = next;
    goesOn_ = true;
  }

 private:
  Rng rng_{0, 0};
  Ray next_;
  Vec3 flux_;
  unsigned maxBounces_ = 0, rough_ = 0, specular_ = 0;
  bool goesOn_ = false, firstScatteringIsDelta_ = false;
  PhotonFate fate_;
};

// Follows one photon to its end.
template <typename Visit>
PhotonFate followPhoton(const Accelerator& accel, PhotonWalk walk, const Visit& visit) {
  SurfacePoint hit;
  while (walk.goesOn()) {
    accel.closestHit(walk.next().origin, walk.next().direction, hit);
    walk.advance(accel, hit, visit);
  }
  return walk.fate();
}

}  // namespace bnvpl
