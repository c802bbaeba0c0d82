// The stage vpl-place without files: where VPLs might stand.
#pragma once

#include "core/progress.h"
#include "formats/vpl_table.h"
#include "tools/common/method.h"
#include "transport/lights.h"
#include "transport/rays.h"

namespace bnvpl {

struct PlaceResult {
  VplTable table;      // of stage Candidates or Lit, as the method says
  uint64_t paths = 0;  // traced until the count was reached
  uint64_t rays = 0;
  uint64_t nonFinite = 0;  // vertices or photons left out because a value was NaN or infinite
  // How the traced paths ended: in the void, on a surface that reflects nothing, or at full depth.
  uint64_t escaped = 0, absorbed = 0, complete = 0;
};

struct PlaceInputs {
  const RayScene& rays;
  const LightSet& lights;
  const ProgressFn& progress;  // counts VPLs
};

// Rows are in path order: the first N of 2N are those of N. Throws InputError when the scene yields
// too few within a bounded effort.
struct PlaceMethod {
  std::string_view name, summary;
  std::span<const Option> options;
  PlaceResult (*make)(const PlaceInputs&, const Values&);
  bool needsLight = false;  // a scene in which nothing shines is refused
  bool forView = true;      // the rows depend on camera and film
};
std::span<const PlaceMethod* const> placeMethods();  // one for each folder beside this file

// count, seed, method, and the methods' own.
const StageSpec& placeSpec();
const PlaceMethod& placeMethod(const Values& options);

// A pure function of the scene and the options: any number of threads gives the same bytes.
PlaceResult place(const RayScene& rays, const LightSet& lights, const Values& options,
                  const ProgressFn& progress = {});

}  // namespace bnvpl
