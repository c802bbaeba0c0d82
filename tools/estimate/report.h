// The summary of vpl-estimate.
#pragma once

#include "tools/common/run_tool.h"
#include "tools/estimate/estimate.h"

namespace bnvpl {

inline constexpr double kBytesPerEstimated = 400;  // of a VPL

// Of a shard, which knows its own part only: samples that were not finite.
void reportShard(const EstimateResult& result, Summary& summary);
void reportEstimate(const EstimateResult& result, Summary& summary);

}  // namespace bnvpl
