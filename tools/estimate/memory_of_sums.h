// Memory that each thread's sums of photons take, in bytes.
#pragma once

#include "formats/vpl/vpl_columns.h"
#include "tools/estimate/emit_points.h"
#include "tools/estimate/photon_emission.h"
#include "tools/estimate/photon_sums.h"

namespace bnvpl {

// A VPL's flux and its emission points.
inline double bytesPerVplAndThread(const Values& options) {
  return sizeof(VplSum) + static_cast<double>(options[kEmitPointsOption]) * sizeof(EmitPoint);
}

// The flux of all VPLs by light group, which methods that send photons sum in each thread.
inline double bytesOfGroups(const VplTable& vpls, const Scene& scene, const Values& options) {
  if (!options.has(kEmissionOption)) return 0.0;
  return static_cast<double>(vpls.size() * scene.lightGroupCount()) * sizeof(GroupSum);
}

}  // namespace bnvpl
