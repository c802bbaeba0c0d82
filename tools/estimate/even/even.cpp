// The method of the thesis (section 3.4): a photon's flux is divided evenly among all VPLs whose
// reach holds the hit, even through walls.
#include "tools/estimate/photon_deposits.h"

namespace bnvpl::methods::estimate::even {

namespace {

void depositEvenly(const PhotonDeposits& deposits, const PhotonHit& hit, Rng&, PhotonSums& sums) {
  uint32_t found = 0;
  ReachGrid::forEachReaching(hit.near, [&](const ReachGrid::Disk&) { ++found; });
  if (found == 0) return deposits.tally(sums, kOutside, hit.flux);
  const Vec3 share = hit.flux * (1.0f / static_cast<float>(found));
  ReachGrid::forEachReaching(
      hit.near, [&](const ReachGrid::Disk& d) { deposits.deposit(d.index, hit, share, sums); });
  deposits.tally(sums, kDeposited, hit.flux);
}

EstimateResult run(const EstimateInputs& in, const Values& options) {
  return estimateByPhotons(in, options, depositEvenly);
}

}  // namespace

extern const EstimateMethod method{
    "even", "photons, divided evenly among all VPLs in reach (thesis); leaks through thin walls",
    kPhotonOptions, run, photonWork};

}  // namespace bnvpl::methods::estimate::even
