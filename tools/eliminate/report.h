// The summary of vpl-eliminate.
#pragma once

#include "tools/common/run/run_tool.h"
#include "tools/eliminate/eliminate.h"

namespace bnvpl {

void reportEliminated(const VplTable& kept, size_t candidates, Summary& summary);

}  // namespace bnvpl
