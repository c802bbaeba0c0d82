// The stage vpl-estimate without its files: estimates the flux that leaves each VPL's share of the
// surface.
#pragma once

#include <string_view>

#include "core/progress.h"
#include "core/work_controls.h"
#include "formats/vpl/vpl_table.h"
#include "tools/common/stage/method.h"
#include "transport/accelerator/accelerator.h"
#include "transport/lights/lights.h"
#include "transport/photons/emission_guide.h"

namespace bnvpl {

// Where the light went, W (linear sRGB, averaged over the channels).
// emitted = escaped + absorbed, and reflected = deposited + outside + incompatible + hidden.
struct EnergyAccount {
  double emitted = 0, escaped = 0, absorbed = 0;
  double reflected = 0;  // flux that leaves the rough hits
  double deposited = 0;  // flux of the hits that found a VPL, before MIS weights
  double outside = 0;    // no VPL reaches the hit: it lies outside the region that lights the view
  double incompatible = 0;  // VPLs reach the hit, but none on a compatible surface
  double hidden = 0;        // some are on a compatible surface, but none is in sight
  uint64_t photons = 0, hits = 0, rays = 0, guardRays = 0;
  uint64_t nonFinite = 0;  // photons cut off because their flux became NaN or infinite
};

struct EstimateResult {
  VplTable table;             // its stage is Lit
  EnergyAccount energy = {};  // covers photons only; nonFinite counts paths, too
  uint64_t paths = 0;
  UsefulPhotons useful = {};  // photons that reach a VPL, as the pilot found
  double workShare = 1.0;     // part of the requested work that was done; less than 1 if enough
  bool photonsAlone = false;  // method `both` sent no paths
};

struct EstimateInputs {
  const VplTable& vpls;  // its stage is Eliminated
  const Accelerator& accel;
  const LightSet& lights;
  const ProgressFn& progress;  // counts units of the method's Work
  const WorkControls& controls;
};

// Amount of work, for progress.
struct Work {
  std::string_view unit;  // such as "photons"
  uint64_t count;
};

struct EstimateMethod {
  std::string_view name, summary;
  std::span<const Option> options;
  EstimateResult (*run)(const EstimateInputs&, const Values&);
  Work (*work)(const VplTable& vpls, const Values&);
};
// Defined in the build folder by cmake/Methods.cmake, from the folders beside this file.
std::span<const EstimateMethod* const> estimateMethods();

// Options of the stage: seed, method, and those of each method.
const StageSpec& estimateSpec();
Work estimateWork(const VplTable& vpls, const Values& options);

// A pure function: neither threads nor interruptions change a bit. Throws InputError if no light
// has power.
EstimateResult estimate(const VplTable& vpls, const Accelerator& accel, const LightSet& lights,
                        const Values& options, const ProgressFn& progress = {},
                        const WorkControls& controls = {});

}  // namespace bnvpl
