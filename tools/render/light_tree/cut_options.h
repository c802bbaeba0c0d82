#pragma once

#include "tools/common/options/option.h"

namespace bnvpl {

// Option of the gather methods that use cuts of the light tree.
inline constexpr WholeOption kMaxCutOption =
    countOption("max-cut", "1000", 0x1p32 - 1, "",
                "number of clusters up to which a cut is refined; the start cut, and near clusters "
                "that tilecuts opens, may make it larger");

}  // namespace bnvpl
