// The summary that vpl-place prints, and the memory that it needs.
#pragma once

#include "tools/common/run/run_tool.h"
#include "tools/place/place.h"

namespace bnvpl {

inline constexpr double kBytesPerPlaced = 40;  // per VPL; a lower bound; measured: 42
inline constexpr double kBytesPerSaved = 76;   // the same beside it, in the state of a checkpoint

void reportPlaced(const PlaceResult& placed, Summary& summary);

}  // namespace bnvpl
