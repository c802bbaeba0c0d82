// Memory that each thread's sums of photons take, in bytes.
#pragma once

#include "formats/vpl/vpl_columns.h"
#include "tools/estimate/emit_points.h"
#include "tools/estimate/photon_sums.h"

namespace bnvpl {

// A VPL's flux and its emission points.
inline double bytesPerVplAndThread(const Values& options) {
  return sizeof(VplSum) + static_cast<double>(options[kEmitPointsOption]) * sizeof(EmitPoint);
}

// The flux of all VPLs by light group.
inline double bytesOfGroups(const VplTable& vpls, const Scene& scene) {
  return static_cast<double>(vpls.size() * scene.lightGroupCount()) * sizeof(GroupSum);
}

}  // namespace bnvpl
