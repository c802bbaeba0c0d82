#include "tools/estimate/estimate.h"

#include <array>

namespace bnvpl {

namespace {

constexpr auto kOptions = optionTable(kSeedOption);

}  // namespace

const StageSpec& estimateSpec() {
  static const StageSpec spec{
      "vpl-estimate",
      kOptions,
      {{"method", "both", "how VPLs get their flux", entriesOf(estimateMethods())}}};
  return spec;
}

Work estimateWork(const VplTable& vpls, const Values& options) {
  return methodNamed(estimateMethods(), options[kMethodSlot]).work(vpls, options);
}

EstimateResult estimate(const VplTable& vpls, const RayScene& rays, const LightSet& lights,
                        const Values& options, const ProgressFn& progress, const Resume& resume) {
  return methodNamed(estimateMethods(), options[kMethodSlot])
      .make({vpls, rays, lights, progress, resume}, options);
}

}  // namespace bnvpl
