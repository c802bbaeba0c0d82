// The walk of one photon, shared by every stage that follows light from its source.
#pragma once

#include "core/random.h"
#include "transport/lights.h"
#include "transport/walk.h"

namespace bnvpl {

// Where a photon's flux went, W.
struct PhotonFate {
  Vec3 escaped;
  Vec3 absorbed;  // by surfaces, and at the end of the longest path
  uint32_t hits = 0, rays = 0;
  bool finite = true;  // false: its flux became NaN or infinite and what was left was dropped
};

// A photon on its way through the scene.
class PhotonWalk {
 public:
  PhotonWalk() = default;
  // The numbers of `rng` go on from those that made `start`.
  PhotonWalk(const PhotonStart& start, unsigned maxBounces, const Rng& rng)
      : rng_(rng),
        next_{start.origin, start.direction},
        flux_(start.flux),
        maxBounces_(maxBounces),
        goesOn_(isFinite(start.flux)) {
    fate_.finite = goesOn_;
  }

  bool goesOn() const { return goesOn_; }
  const Ray& next() const { return next_; }  // to be traced, where goesOn()
  const PhotonFate& fate() const { return fate_; }
  // Whether its first scattering was by a perfect mirror or glass. Of lights that no ray can hit,
  // no path from the other end finds such light.
  bool beganAtPerfectMirror() const { return beganAtPerfectMirror_; }
  Rng& rng() { return rng_; }
  // One of several that go on from here instead of this one, with a share of its flux each. Their
  // fates hold the way before once more.
  PhotonWalk branch(float share, const Rng& rng) const {
    PhotonWalk b = *this;
    b.rng_ = rng;
    b.flux_ *= share;
    return b;
  }

  // Takes what next() has hit; hit.triangle is kNone where it has left the scene. Where the hit has
  // rough lobes, visit(bsdf, flux, firstBounce) gets the flux that arrives (before albedo), shading
  // normals accounted for, and whether nothing was between the light and the hit; at most
  // maxBounces times, counting the rough scatterings so far plus this one. Russian roulette by
  // reflectance keeps the flux about level.
  template <typename Visit>
  void advance(const RayScene& rays, const SurfacePoint& hit, const Visit& visit) {
    ++fate_.rays;
    goesOn_ = false;
    if (hit.triangle == kNone) {
      fate_.escaped += flux_;
      return;
    }
    const Bsdf bsdf(rays.scene(), hit);
    // What does not travel on counts as absorbed, roulette included: escaped + absorbed = emitted
    // exactly.
    fate_.absorbed += flux_;
    if (bsdf.hasRough()) {
      const Vec3 arriving = flux_ * bsdf.photonShadingFactor();
      if (!isFinite(arriving)) {
        fate_.finite = false;
        return;
      }
      ++fate_.hits;
      visit(bsdf, arriving, rough_ + specular_ == 0);
    }
    const float survive = bsdf.reflectance();
    if (rng_.next() >= survive) return;
    const LobeChoice lobes = chooseLobes(bsdf, rng_);
    if (rough_ + specular_ == 0) beganAtPerfectMirror_ = lobes.specular() && bsdf.specularIsDelta();
    const bool last = lobes.specular() ? ++specular_ > kMaxSpecular : ++rough_ >= maxBounces_;
    BsdfSample sample;
    Ray next;
    if (last || !scatter(rays, bsdf, lobes.group, Transport::Photons, rng_, sample, next)) return;
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
  bool goesOn_ = false, beganAtPerfectMirror_ = false;
  PhotonFate fate_;
};

// Follows one photon to its end.
template <typename Visit>
PhotonFate followPhoton(const RayScene& rays, PhotonWalk walk, const Visit& visit) {
  SurfacePoint hit;
  while (walk.goesOn()) {
    rays.closestHit(walk.next().origin, walk.next().direction, hit);
    walk.advance(rays, hit, visit);
  }
  return walk.fate();
}

}  // namespace bnvpl
