// The summary of vpl-estimate.
#pragma once

#include "tools/common/run_tool.h"
#include "tools/estimate/estimate.h"

namespace bnvpl {

void reportEstimate(const EstimateResult& result, Summary& summary);

}  // namespace bnvpl
