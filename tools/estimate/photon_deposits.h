// Shared by the photon methods of vpl-estimate: photons from all lights, and the exact sums of
// their deposits. The methods differ only in the rule that divides a hit's flux among the VPLs
// around it.
#pragma once

#include <array>
#include <functional>
#include <optional>

#include "tools/estimate/estimate.h"
#include "tools/estimate/lit_columns.h"
#include "tools/estimate/photon_emission.h"
#include "tools/estimate/photon_sums.h"
#include "tools/estimate/photons_per_light.h"
#include "transport/coverage.h"
#include "transport/photons/emission_guide.h"
#include "transport/vpl_groups.h"

namespace bnvpl {

// Photons that shards and progress count together.
inline constexpr uint64_t kPhotonsPerRange = 4096;

// Options of the photon methods. Sums over more than 2^36 photons would exceed their fixed-point
// range.
inline constexpr auto kPhotonsOption = inTopic(
    Topic::Main, countOption("photons", "10M", 0x1p36, "", "photons from all lights in total"));
inline constexpr auto kPhotonBouncesOption =
    inTopic(Topic::Quality,
            wholeOption("max-bounces", "32", 1, 1000, "", "hits of a photon on rough surfaces"));
inline constexpr auto kPhotonOptions = optionTable(kPhotonsOption, kEmissionOption, kRadiusOption,
                                                   kPhotonBouncesOption, kEmitPointsOption);
inline Work photonWork(const VplTable&, const Values& options) {
  return {"photons", options[kPhotonsOption]};
}

// Hit of a photon on a rough surface.
struct PhotonHit {
  const SurfacePoint& point;
  const ReachGrid::Lookup& near;  // VPLs that reach the hit
  Vec3 flux;                      // flux that leaves the hit, W
  bool firstBounce;               // the photon came straight from a light
  bool onlyPhotons;               // paths from the hit cannot find this light
  float density;                  // that of the photon's start, relative to emission by power
  uint32_t group;                 // light group
};

// Adds deposits of hits to exact sums. Thread-safe where each thread has its own sums.
class PhotonDeposits {
 public:
  // Borrows all but the numbers.
  PhotonDeposits(const EstimateInputs& in, const Coverage& coverage, float radius,
                 uint64_t photons);

  // Photons share the flux of VPL i with paths: their deposits weigh g / (g + misRatios[i]) by
  // the density g of their start (PhotonMis). Light that only photons find weighs 1, and so does
  // all unless ratios are set.
  void setMisRatios(std::span<const float> misRatios) { misRatios_ = misRatios; }
  // deposit() adds all or a part of a hit's flux, weighed, to one VPL. tally() records what became
  // of a whole hit.
  void deposit(uint32_t vpl, const PhotonHit& hit, Vec3 flux, PhotonSums& sums) const;
  void tally(PhotonSums& sums, Tally t, Vec3 flux) const {
    addChecked(sums.tally[t], fixed_.encode(double{mean(flux)}));
  }
  const Coverage& coverage() const { return coverage_; }
  const FixedPoint& fixed() const { return fixed_; }
  double photonPower() const { return photonPower_; }  // mean power of a photon, W
  // Variance of the flux of a VPL if deposits are independent, W^2.
  double variance(const VplSum& s) const { return squaresOf(s.squares); }
  // The part of it from light that paths cannot find, and the rest if photons started in proportion
  // to power.
  double onlyVariance(const VplSum& s) const { return squaresOf(s.onlySquares); }
  double varianceByPower(const VplSum& s) const { return squaresOf(s.squaresByPower); }
  uint32_t groups() const { return groups_; }  // light groups; 0: not told apart
  // The flux of each VPL by light group.
  VplGroups groupFlux(const PhotonSums& sums) const;
  float radius() const { return radius_; }  // reach, in units of each VPL's radius

 private:
  double squaresOf(int64_t units) const {
    return static_cast<double>(units) * squareUnit_ * photonPower_ * photonPower_;
  }

  std::span<const Vec3> position_;  // VPLs
  std::span<const float> vplRadius_;
  float radius_;
  uint32_t groups_;
  double photonPower_;
  FixedPoint fixed_;
  double invPhotonPower_;
  // Unit of VplSum::squares, which leaves room for the deposits of all photons.
  double squareUnit_;
  const Coverage& coverage_;
  std::span<const float> misRatios_;
};

// Deposits a hit; must be thread-safe. `rng` continues the photon's random numbers.
using DepositRule =
    std::function<void(const PhotonDeposits&, const PhotonHit&, Rng& rng, PhotonSums& sums)>;

// Deposits the whole hit in one VPL, drawn uniformly from those on a compatible surface and in
// sight.
void depositToOneInSight(const PhotonDeposits& deposits, const PhotonHit& hit, Rng& rng,
                         PhotonSums& sums);

// Parameters of tracePhotons().
struct PhotonRun {
  uint64_t key;       // random numbers
  size_t emitPoints;  // per VPL
  unsigned maxBounces;
  const PhotonsPerLight& perLight;
  const PhotonDeposits& deposits;
  const EmissionGuide* guide = nullptr;  // null: photons by power
};
// Traces all photons and returns their sums. `in.controls` and `in.progress` are for this run
// alone; progress counts photons.
PhotonSums tracePhotons(const EstimateInputs& in, const PhotonRun& run, const DepositRule& rule);
// WorkControls state of a run that has traced all of its photons.
std::string finishedState(const PhotonSums& sums, uint64_t photons);

EnergyAccount accountOf(const PhotonSums& sums, const PhotonDeposits& deposits, uint64_t photons);

// The whole estimate by one rule and kPhotonOptions. Fills the columns of stage Lit.
EstimateResult estimateByPhotons(const EstimateInputs& in, const Values& options,
                                 const DepositRule& rule);

}  // namespace bnvpl
