// What vpl-place prints, and what it takes.
#pragma once

#include "tools/common/run_tool.h"
#include "tools/place/place.h"

namespace bnvpl {

inline constexpr double kBytesPerPlaced = 40;  // measured: 42

void reportPlaced(const PlaceResult& placed, Summary& summary);

}  // namespace bnvpl
