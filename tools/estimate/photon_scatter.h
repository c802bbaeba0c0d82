// What the photon methods of vpl-estimate share: photons from all lights, and the exact sums of
// what they bring. A method is the rule by which a hit is handed to the VPLs around it.
#pragma once

#include <array>
#include <functional>
#include <optional>

#include "tools/estimate/estimate.h"
#include "tools/estimate/photon_shares.h"
#include "tools/estimate/photon_sums.h"
#include "tools/estimate/vpl_surface.h"
#include "transport/coverage.h"

namespace bnvpl {

// Of every method that traces photons. Sums of more than 2^36 would leave their fixed-point range.
inline constexpr std::array kPhotonOptions{
    countOption("photons", "10M", 0x1p36, "", "photons from all lights together"), kRadiusOption,
    wholeOption("max-bounces", "32", 1, 1000, "", "diffuse hits of a photon"), kEmitPointsOption};
inline Work photonWork(const VplTable&, const Values& options) {
  return {"photons", options.whole("photons")};
}

// A photon's diffuse hit.
struct PhotonHit {
  const SurfacePoint& point;
  const ReachGrid::Lookup& near;  // the VPLs that reach it
  Vec3 flux;                      // that leaves it, W
  bool firstBounce;               // straight from a light
  bool onlyPhotons;               // paths from the hit find no such light
};

// Where hits are handed to VPLs: exact sums, one set for each thread.
class PhotonScatter {
 public:
  PhotonScatter(const VplTable& vpls, const RayScene& rays, float radius, double photonPower,
                uint64_t photons);

  // Of the light that paths find as well, the share that counts, for each VPL; without, all of it.
  void setShare(std::span<const double> share) { share_ = share; }
  // To one VPL, in part or whole; and where the flux of a whole hit went.
  void deposit(uint32_t vpl, const PhotonHit& hit, Vec3 flux, PhotonSums& sums) const;
  void tally(PhotonSums& sums, Tally t, Vec3 flux) const {
    addChecked(sums.tally[t], fixed_.encode(double{mean(flux)}));
  }
  const Coverage& coverage() const { return coverage_; }
  const FixedPoint& fixed() const { return fixed_; }
  double photonPower() const { return photonPower_; }  // W, of a mean photon
  float radius() const { return radius_; }             // reach, in units of each VPL's r_max

 private:
  float radius_;
  FixedPoint fixed_;
  double photonPower_, perPhotonPower_;
  Coverage coverage_;
  std::span<const double> share_;
};

// Hands a hit over; thread-safe. `rng` goes on with the photon's numbers.
using ScatterRule =
    std::function<void(const PhotonScatter&, const PhotonHit&, Rng& rng, PhotonSums& sums)>;

// Evenly among the VPLs on a compatible surface and in sight, in expectation: one of them gets all.
void scatterToOneInSight(const PhotonScatter& scatter, const PhotonHit& hit, Rng& rng,
                         PhotonSums& sums);

// Photons of one key.
struct PhotonRun {
  uint64_t key;
  size_t emitPoints;  // of each VPL
  unsigned maxBounces;
  const PhotonShares& shares;
  const PhotonScatter& scatter;
};
// What they bring. `in.resume` and `in.progress`, in photons, are those of this run alone.
PhotonSums tracePhotons(const EstimateInputs& in, const PhotonRun& run, const ScatterRule& rule);
// The state with which a run of so many photons, resumed, is at its end.
std::string finishedState(const PhotonSums& sums, uint64_t photons);

EnergyAccount accountOf(const PhotonSums& sums, const PhotonScatter& scatter, uint64_t photons);

// The whole estimate by that rule and kPhotonOptions: fills the columns since Lit.
EstimateResult estimateByPhotons(const EstimateInputs& in, const Values& options,
                                 const ScatterRule& rule);

}  // namespace bnvpl
