// What ran where and how long: `vpl-inspect run`.
#pragma once

#include "tools/common/run_tool.h"
#include "tools/inspect/run_records.h"

namespace bnvpl {

// Totals, stages in their order, hosts, the critical path, and every attempt. Keys carry their
// units. A task takes from its first start to its last end, with the waits between its attempts;
// the critical path is the chain of stages whose longest tasks take longest together: less, no
// number of machines can do. Throws InputError where stages come after each other in a circle.
Json describeRun(const RunRecords& run);

// The same for people, ends with a line feed.
std::string runText(const Json& description);

// The stages, each after those whose files it reads, else by their first start.
std::vector<std::string> stagesInOrder(const RunRecords& run);

}  // namespace bnvpl
