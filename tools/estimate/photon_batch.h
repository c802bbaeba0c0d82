// Photons of vpl-estimate on their ways through the scene.
#pragma once

#include <utility>
#include <vector>

#include "tools/estimate/photon_deposits.h"
#include "transport/photons/photon_walk.h"

namespace bnvpl {

// Photons that advance together, one ray each per round, which hides the latency of memory.
class PhotonBatch {
 public:
  PhotonBatch(const Accelerator& accel, const PhotonDeposits& deposits, const DepositRule& rule)
      : accel_(accel),
        deposits_(deposits),
        rule_(rule),
        photons_(kSize),
        hittable_(kSize),
        group_(kSize),
        density_(kSize),
        next_(kSize),
        hits_(kSize),
        near_(kSize) {}

  // Follows photons to their ends. start(walk, hittable, group, density) makes the next photon and
  // sets whether rays can hit its light, its light group, and the density of its start; it returns
  // false if none is left.
  template <typename Start>
  void follow(const Start& start, PhotonSums& sums) {
    size_t size = 0;
    while (size < kSize && startAt(size, start)) ++size;
    while (size > 0) {
      // New photons replace those that have ended.
      for (size_t i = 0; i < size;) {
        PhotonWalk& photon = photons_[i];
        if (photon.goesOn()) {
          next_[i++] = photon.next();
          continue;
        }
        finish(photon, sums);
        if (startAt(i, start)) continue;
        photon = photons_[--size];
        hittable_[i] = hittable_[size];
        group_[i] = group_[size];
        density_[i] = density_[size];
      }
      intersect(size);
      for (size_t i = 0; i < size; ++i) {
        photons_[i].advance(accel_, hits_[i], [&](const Bsdf& bsdf, Vec3 flux, bool firstBounce) {
          const Vec3 leaving = flux * bsdf.exactRoughAlbedo();
          ++sums.hits;
          deposits_.tally(sums, kReflected, leaving);
          const bool onlyPhotons = !hittable_[i] && photons_[i].firstScatteringIsDelta();
          rule_(deposits_,
                {bsdf.point(), near_[i], leaving, firstBounce, onlyPhotons, density_[i], group_[i]},
                photons_[i].rng(), sums);
        });
      }
    }
  }

 private:
  static constexpr size_t kSize = Accelerator::kBatch;

  template <typename Start>
  bool startAt(size_t i, const Start& start) {
    bool hittable = false;
    if (!start(photons_[i], hittable, group_[i], density_[i])) return false;
    hittable_[i] = hittable;
    return true;
  }
  // Finds the hits of the first `size` photons, and the VPLs near them.
  void intersect(size_t size) {
    accel_.closestHits({next_.data(), size}, hits_);
    deposits_.coverage().lookUp(std::span(std::as_const(hits_)).first(size), near_);
  }
  void finish(const PhotonWalk& photon, PhotonSums& sums) const {
    const PhotonFate& fate = photon.fate();
    deposits_.tally(sums, kEscaped, fate.escaped);
    deposits_.tally(sums, kAbsorbed, fate.absorbed);
    sums.rays += fate.rays;
    sums.nonFinite += fate.finite ? 0 : 1;
  }

  const Accelerator& accel_;
  const PhotonDeposits& deposits_;
  const DepositRule& rule_;
  // One entry per photon: its walk, whether rays can hit its light, its light group, the density of
  // its start, its next ray, the hit, and VPLs near it.
  std::vector<PhotonWalk> photons_;
  std::vector<uint8_t> hittable_;
  std::vector<uint32_t> group_;
  std::vector<float> density_;
  std::vector<Ray> next_;
  std::vector<SurfacePoint> hits_;
  std::vector<ReachGrid::Lookup> near_;
};

}  // namespace bnvpl
