// Reports what a pipeline ran, where and for how long: `vpl-inspect run`.
#pragma once

#include "tools/common/run/run_tool.h"
#include "tools/inspect/run/run_records.h"

namespace bnvpl {

// Totals, stages in order, hosts, the critical path, and every attempt. Keys carry their units. The
// time of a task extends from its first start to its last end and includes waits between attempts.
// The critical path is the chain of stages whose longest tasks have the largest total time, a lower
// bound for any number of machines. Throws InputError if the order of the stages has a cycle.
Json describeRun(const RunRecords& run);

// The description for people, with a line feed at the end.
std::string runText(const Json& description);

// The stages, each after those whose files it reads, otherwise by first start.
std::vector<std::string> stagesInOrder(const RunRecords& run);

}  // namespace bnvpl
