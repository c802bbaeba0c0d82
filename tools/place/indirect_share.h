// Share of the light in view that is indirect. Errors of VPLs matter to an image by this share.
#pragma once

#include "core/resume.h"
#include "tools/place/place.h"

namespace bnvpl {

// Mean over the film of indirect light / all light, 0 to 1: 32 paths at each of 256 points, whose
// shares count alike, so that no lamp in view outweighs the rest. Points without light do not
// count. Of several views, the one with the largest share decides, and of more than 16 views only
// 16 are asked. 1 if no point has light. The result does not depend on threads.
double indirectShare(const PlaceInputs& in, uint64_t seed);

// The share in the files of shards. takeIndirectShare() throws InputError if there is none, or one
// that is not 0 to 1.
void giveIndirectShare(const ShardSink& sink, double share);
double takeIndirectShare(const ShardSource& source);

}  // namespace bnvpl
