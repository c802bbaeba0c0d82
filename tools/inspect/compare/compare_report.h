// Report and exit code of `vpl-inspect compare`.
#pragma once

#include <string>

#include "images/comparison.h"
#include "tools/common/process/exit_codes.h"
#include "tools/common/run/run_tool.h"

namespace bnvpl {

struct CompareOptions {
  double epsilon = kRelMseEpsilon;
  std::optional<double> maxRelMse, maxRmse, maxRmseOverMean;  // none: no limit
};

Json comparisonJson(const Comparison& c, const CompareOptions& options);
std::string comparisonText(const Comparison& c, const CompareOptions& options);

// kExitDifferent if a limit is exceeded, otherwise kExitOk. Infinite and undefined measures exceed
// any limit.
int comparisonExitCode(const Comparison& c, const CompareOptions& options);

}  // namespace bnvpl
