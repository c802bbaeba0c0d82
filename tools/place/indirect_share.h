// The share of the light in view that is indirect: errors of VPLs show in the image in this
// proportion.
#pragma once

#include "core/work_controls.h"
#include "tools/place/place.h"

namespace bnvpl {

// Mean over the film of indirect light / all light, 0 to 1: 32 paths at each of 256 points, whose
// shares count alike, so that no lamp in view outweighs the rest. Points without light do not
// count. With several views the largest share counts; of more than 16 views, 16
// are asked. 1 if no point has light. The result does not depend on threads.
double indirectShare(const PlaceInputs& in, uint64_t seed);

// The share in the files of shards. takeIndirectShare() throws InputError if there is none, or one
// that is not 0 to 1.
void giveIndirectShare(const ShardSink& sink, double share);
double takeIndirectShare(const ShardSource& source);

}  // namespace bnvpl
