// --estimate of vpl-place.
#pragma once

#include "tools/common/stage/cost.h"
#include "tools/place/place.h"

namespace bnvpl {

// What place() will take, found by placing some of the VPLs. `rowBytes` is what all rows take in
// memory, 0 where a shard writes them as they come.
Cost costOfPlacing(const PlaceInputs& inputs, const Values& options, const ProgressFn& progress,
                   double rowBytes);

}  // namespace bnvpl
