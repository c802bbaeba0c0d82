// The stage vpl-estimate without files: the flux that leaves each VPL's share of the surface.
#pragma once

#include <string_view>

#include "core/progress.h"
#include "core/resume.h"
#include "formats/vpl_table.h"
#include "tools/common/method.h"
#include "transport/lights.h"
#include "transport/rays.h"

namespace bnvpl {

// Where the light went, W (linear sRGB, averaged over the channels).
// emitted = escaped + absorbed, and reflected = deposited + outside + incompatible + hidden.
struct EnergyAccount {
  double emitted = 0, escaped = 0, absorbed = 0;
  double reflected = 0;  // flux that leaves the diffuse hits
  double deposited = 0;  // handed to VPLs
  double outside = 0;    // no VPL reaches the hit: it lies outside the region that lights the view
  double incompatible = 0;  // VPLs reach the hit, but none on a compatible surface
  double hidden = 0;        // some are on a compatible surface, but none is in sight
  uint64_t photons = 0, hits = 0, rays = 0, guardRays = 0;
  uint64_t nonFinite = 0;  // photons cut off because their flux became NaN or infinite
};

struct EstimateResult {
  VplTable table;             // of stage Lit
  EnergyAccount energy = {};  // of photons, but for nonFinite, which counts paths as well
  uint64_t paths = 0;
  double workShare = 1.0;  // done of what was asked for: less where that was enough
};

struct EstimateInputs {
  const VplTable& vpls;  // of stage Eliminated
  const RayScene& rays;
  const LightSet& lights;
  const ProgressFn& progress;  // counts what the method's Work does
  const Resume& resume;
};

// What there is to do, for progress.
struct Work {
  std::string_view unit;  // "photons"
  uint64_t count;
};

struct EstimateMethod {
  std::string_view name, summary;
  std::span<const Option> options;
  EstimateResult (*make)(const EstimateInputs&, const Values&);
  Work (*work)(const VplTable& vpls, const Values&);
};
std::span<const EstimateMethod* const> estimateMethods();  // one for each folder beside this file

// seed, method, and the methods' own.
const StageSpec& estimateSpec();
Work estimateWork(const VplTable& vpls, const Values& options);

// A pure function: any number of threads, and any interruption that `resume` mends, gives the same
// bits. Throws InputError when no light has power.
EstimateResult estimate(const VplTable& vpls, const RayScene& rays, const LightSet& lights,
                        const Values& options, const ProgressFn& progress = {},
                        const Resume& resume = {});

}  // namespace bnvpl
