#include "tools/eliminate/eliminate.h"

#include <array>
#include <string>

#include "core/errors.h"
#include "formats/vpl/vpl_io.h"

namespace bnvpl {

namespace {

constexpr auto kOptions = optionTable(kEliminateCountOption);

void requireEnough(const EliminateMethod& method, size_t candidates, uint64_t count) {
  if (candidates > INT32_MAX) throw InputError("more than 2^31 - 1 candidates; place fewer");
  if (count <= candidates) return;
  const std::string cure = count > INT32_MAX / 20
                               ? "keep fewer"
                               : "rerun " + std::string(method.madeBy) + " -n " +
                                     std::to_string(count * 20) + " (20 to 40 x " +
                                     std::to_string(count) + ")";
  throw InputError("asked to keep " + std::to_string(count) + " of " + std::to_string(candidates) +
                   " candidates; " + cure);
}

}  // namespace

const StageSpec& eliminateSpec() {
  static const StageSpec spec{
      "vpl-eliminate",
      kOptions,
      {{"method", "elimination", "which candidates stay", entriesOf(eliminateMethods())}},
      {{"the best spread 6000 of the candidates",
        "vpl-eliminate candidates.vpl -o vpls.vpl -n 6000"},
       {"the same spacing everywhere",
        "vpl-eliminate candidates.vpl -o vpls.vpl -n 6k --density uniform"},
       {"VPLs from the lights, kept by what they do for the image",
        "vpl-eliminate light.vpl -o lit.vpl -n 6k --method rejection --scene scene.toml"}}};
  return spec;
}

const EliminateMethod& eliminateMethod(const Values& options) {
  return methodNamed(eliminateMethods(), options[kMethodSlot]);
}

void requireSceneAsNeeded(const EliminateMethod& method, bool given) {
  if (method.needsScene == given) return;
  throw UsageError(
      "--method " + std::string(method.name) +
      (given ? " takes no scene; leave --scene out" : " needs the scene; add --scene SCENE"));
}

VplTable eliminate(const VplTable& candidates, const Values& options, const Accelerator* accel,
                   const LightSet* lights, const ProgressFn& progress) {
  const EliminateMethod& method = eliminateMethod(options);
  requireSceneAsNeeded(method, accel && lights);
  requireEnough(method, candidates.size(), options[kEliminateCountOption]);
  const EliminateResult kept = method.run({candidates, accel, lights, progress}, options);
  VplTable table = keepRows(candidates, kept.rows);
  if (table.stage == VplStage::Candidates) table.stage = VplStage::Eliminated;
  table.radius = kept.radius;
  table.rMax = kept.rMax;
  table.areaEstimate = kept.area;
  for (size_t i = 0; i < kept.weight.size(); ++i) {
    table.flux[i] *= kept.weight[i];
    table.firstBounceFlux[i] *= kept.weight[i];
  }
  return table;
}

}  // namespace bnvpl
