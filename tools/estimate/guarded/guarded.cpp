// Deposits photons only in VPLs on a compatible surface and in sight of the hit.
#include "tools/estimate/photon_deposits.h"

namespace bnvpl::methods::estimate::guarded {

namespace {

EstimateResult run(const EstimateInputs& in, const Values& options) {
  return estimateByPhotons(in, options, depositToOneInSight);
}

}  // namespace

extern const EstimateMethod method{"guarded",
                                   "photons, to VPLs on compatible surfaces that the hit can see",
                                   kPhotonOptions, run, photonWork};

}  // namespace bnvpl::methods::estimate::guarded
