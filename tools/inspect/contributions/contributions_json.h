// The file of `vpl-inspect contributions`; docs/inspect.md describes it.
#pragma once

#include "tools/common/files/json_text.h"
#include "tools/inspect/contributions/contributions.h"
#include "tools/inspect/rows_in_view.h"

namespace bnvpl {

// `rows`: where each row of `lit` stands in the view.
Json contributionsJson(const Contributions& found, const VplTable& lit,
                       const std::vector<RowInView>& rows, float clamp);

}  // namespace bnvpl
