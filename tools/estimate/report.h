// The summary of vpl-estimate.
#pragma once

#include "tools/common/run/run_tool.h"
#include "tools/estimate/estimate.h"

namespace bnvpl {

// A shard knows only its own part, so it reports just the samples that were not finite.
void reportShard(const EstimateResult& result, Summary& summary);
void reportEstimate(const EstimateResult& result, Summary& summary);

}  // namespace bnvpl
