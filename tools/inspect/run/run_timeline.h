// Draws the timeline of a run: hosts downwards, time to the right, a bar for each attempt.
#pragma once

#include "tools/inspect/run/run_records.h"

namespace bnvpl {

// Returns an SVG. Bars have the colour of their stage. Failed attempts are framed in red. Attempts
// without a known end are hatched and extend to the next attempt of their task, or to the end of
// the run. Names in records may hold any printable characters.
std::string timelineSvg(const RunRecords& run);

}  // namespace bnvpl
