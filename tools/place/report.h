// The summary that vpl-place prints, and the memory that it needs.
#pragma once

#include "tools/common/run/run_tool.h"
#include "tools/place/place.h"

namespace bnvpl {

// Bytes per VPL: a lower bound (measured: 42), and what a checkpoint's records take besides.
inline constexpr double kBytesPerPlaced = 40, kBytesPerSaved = 76;

void reportPlaced(const PlaceResult& placed, Summary& summary);

}  // namespace bnvpl
