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
      {{"method", "both", "how VPLs get their flux", entriesOf(estimateMethods())}},
      {{"the flux of all VPLs", "vpl-estimate scenes/cornell/scene.toml vpls.vpl -o lit.vpl"},
       {"less work, for a preview", "vpl-estimate scene.toml vpls.vpl -o lit.vpl --photons 1M"},
       {"a long run that may be stopped and goes on where it was",
        "vpl-estimate scene.toml vpls.vpl -o lit.vpl --photons 1G --checkpoint saved"}}};
  return spec;
}

Work estimateWork(const VplTable& vpls, const Values& options) {
  return methodNamed(estimateMethods(), options[kMethodSlot]).work(vpls, options);
}

EstimateResult estimate(const VplTable& vpls, const Accelerator& accel, const LightSet& lights,
                        const Values& options, const ProgressFn& progress,
                        const WorkControls& controls) {
  return methodNamed(estimateMethods(), options[kMethodSlot])
      .run({vpls, accel, lights, progress, controls}, options);
}

}  // namespace bnvpl
