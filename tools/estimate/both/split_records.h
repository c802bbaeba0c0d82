// The split in the files of shards.
#pragma once

#include "core/work_controls.h"
#include "tools/estimate/both/split.h"

namespace bnvpl::methods::estimate::both {

// Every shard computes the same split, since each runs the whole pilots. The first one records it.
void giveSplit(const ShardSink& sink, const Split& split);
Split takeSplit(const ShardSource& source, size_t vpls);

}  // namespace bnvpl::methods::estimate::both
