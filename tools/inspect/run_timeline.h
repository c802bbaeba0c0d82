// A run as a picture: hosts downwards, time to the right, a bar for each attempt.
#pragma once

#include "tools/inspect/run_records.h"

namespace bnvpl {

// An SVG. Bars have the colour of their stage. Those of attempts that failed are framed in red;
// those without a known end are hatched and go on to the next attempt of their task, or to the end
// of the run. Names of records may hold any printable characters.
std::string timelineSvg(const RunRecords& run);

}  // namespace bnvpl
