// --estimate of vpl-eliminate.
#pragma once

#include "tools/common/stage/cost.h"
#include "tools/eliminate/eliminate.h"

namespace bnvpl {

// What eliminate() will take, found by eliminating some of the candidates.
Cost costOfEliminating(const VplTable& candidates, const Values& options, const Accelerator* accel,
                       const LightSet* lights, const ProgressFn& progress);

}  // namespace bnvpl
