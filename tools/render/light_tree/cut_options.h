#pragma once

#include "tools/common/option.h"

namespace bnvpl {

// Of every gather that takes cuts of the light tree.
inline constexpr Option kMaxCutOption =
    countOption("max-cut", "1000", 0x1p32 - 1, "",
                "clusters up to which a cut is refined; the tree's starting cut may hold more");

}  // namespace bnvpl
