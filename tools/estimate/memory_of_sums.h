// Memory that vpl-estimate and vpl-merge take at least, in bytes.
#pragma once

#include <algorithm>

#include "tools/estimate/photon_deposits.h"
#include "tools/estimate/vpl_paths.h"

namespace bnvpl {

// For each VPL, with this many threads (0 for vpl-merge). Each thread has sums of photons of its own,
// and one more holds the total; lit columns come after those of the threads.
inline double bytesPerEstimated(const Values& options, double threads) {
  constexpr double kOther = 300;  // measured: 370 to 600 in vpl-estimate
  const auto points = static_cast<double>(options[kEmitPointsOption]);
  const double ofPoints = points * sizeof(EmitPoint), columns = points * 2.0 * sizeof(Vec3);
  const double paths = sizeof(PathSums) + ofPoints, photons = sizeof(VplSum) + ofPoints;
  if (!options.has(kEmissionOption)) return kOther + paths + columns;
  const double after = photons + columns + (options.has(kPathsOption) ? paths : 0.0);
  return kOther + std::max((threads + 1.0) * photons, after);
}

// The flux of all VPLs by light group, which methods that send photons sum in each thread.
inline double bytesOfGroups(const VplTable& vpls, const Scene& scene, const Values& options) {
  if (!options.has(kEmissionOption)) return 0.0;
  return static_cast<double>(vpls.size() * scene.lightGroupCount()) * sizeof(GroupSum);
}

}  // namespace bnvpl
