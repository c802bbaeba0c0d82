// Photons go to VPLs that the hit could stand for: on a compatible surface and in sight.
#include "tools/estimate/photon_scatter.h"

namespace bnvpl::methods::estimate::guarded {

namespace {

// Evenly among those on a compatible surface and in sight, in expectation: one of them gets all.
void scatterHit(const PhotonScatter& scatter, const PhotonHit& hit, Rng& rng, PhotonSums& sums) {
  const Coverage::Found found =
      scatter.coverage().pick(hit.point.position, hit.point.ng, hit.near, rng);
  sums.guardRays += found.rays;
  if (found.vpl) {
    scatter.deposit(*found.vpl, hit, hit.flux, sums);
    return scatter.tally(sums, kDeposited, hit.flux);
  }
  scatter.tally(sums,
                found.miss == Coverage::Miss::Outside ? kOutside
                : found.miss == Coverage::Miss::Gap   ? kGap
                                                      : kHidden,
                hit.flux);
}

EstimateResult make(const EstimateInputs& in, const Values& options) {
  return estimateByPhotons(in, options, scatterHit);
}

}  // namespace

extern const EstimateMethod method;
const EstimateMethod method{"guarded",
                            "photons, to VPLs on compatible surfaces that the hit can see",
                            kPhotonOptions, make, photonWork};

}  // namespace bnvpl::methods::estimate::guarded
