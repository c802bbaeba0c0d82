// The methods of --integrator, which estimate the radiance along camera rays. Each is a folder
// beside this file.
#pragma once

#include <span>

#include "core/cost_trial.h"
#include "core/progress.h"
#include "formats/vpl/vpl_table.h"
#include "tools/common/stage/method.h"
#include "tools/render/compensate/compensate.h"
#include "tools/render/film/integrator.h"
#include "tools/render/gather/gather.h"
#include "tools/render/pixel_filter.h"
#include "transport/accelerator/accelerator.h"
#include "transport/lights/lights.h"
#include "transport/vpl_groups.h"

namespace bnvpl {

// Inputs of a method, borrowed until the image is done.
struct IntegratorInputs {
  const Accelerator& accel;
  const LightSet& lights;
  const VplTable& lit;  // stage Lit; empty unless the method needs VPLs
  uint64_t seed;
  ShownLight shown;
  PixelFilter filter;
  const ProgressFn& progress;  // reports preparations
  CostTrial* trial = nullptr;  // set for a cost estimate
  uint32_t groups = 0;         // light groups that samples tell apart; 0: none
  VplGroups litGroups = {};    // the VPLs' flux by these groups; empty without them

  uint64_t pixels() const {
    const Film& film = accel.scene().film;
    return trial ? trial->pixels : uint64_t{film.width} * film.height;
  }
};

inline constexpr OptionKey<std::string> kIntegratorSlot{"integrator"}, kGatherSlot{"gather"},
    kCompensateSlot{"compensate"};

// Option of the integrators that use camera samples.
constexpr TextOption firefliesOption(std::string_view defaultText) {
  return choiceOption(
      "fireflies", defaultText, "redistribute|keep",
      "excess of samples and photons that are far brighter than their surroundings: "
      "redistributed over the surface around, or kept");
}

// Whether fireflies are redistributed; false for methods without the option.
inline bool redistributesFireflies(const Values& options) {
  return options.meet(valueIs(firefliesOption({}), "redistribute"));
}

// The gather of a run; null where nothing is gathered.
inline const GatherMethod* gatherOf(const Values& options) {
  if (!options.has(kGatherSlot)) return nullptr;
  return &methodNamed(gatherMethods(), options[kGatherSlot]);
}
// The compensation of a run; null where nothing is compensated.
inline const CompensateMethod* compensationOf(const Values& options) {
  if (!options.has(kCompensateSlot)) return nullptr;
  return &methodNamed(compensateMethods(), options[kCompensateSlot]);
}
// The gather's film filter; empty where there is none.
inline GatherFilter gatherFilterOf(const Values& options) {
  const GatherMethod* gather = gatherOf(options);
  return gather && gather->gatherFilter ? gather->gatherFilter(options) : GatherFilter{};
}
// Whether it finds the sum over a pixel's samples instead of their light.
inline bool gathersPixelSums(const Values& options) {
  const GatherMethod* gather = gatherOf(options);
  return gather && gather->pixelSum;
}

// `make` returns an Integrator (film/integrator.h).
struct IntegratorMethod {
  std::string_view name, summary;
  std::span<const Option> options;
  Integrator (*make)(const IntegratorInputs&, const Values&);
  bool needsVpls = false;
  // Sets Integrator::splatPhotons; photons traced by `make` do not count.
  bool splatsPhotons = false;
  bool gathersVpls = false;  // --gather and --compensate apply
};
// Defined in the build folder by cmake/Methods.cmake, from the folders beside this file.
std::span<const IntegratorMethod* const> integratorMethods();

}  // namespace bnvpl
