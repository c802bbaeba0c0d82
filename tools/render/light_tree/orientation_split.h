// The surface area orientation heuristic (Conty Estevez & Kulla 2018).
#pragma once

#include <cstdint>
#include <span>

#include "transport/virtual_light/virtual_light.h"

namespace bnvpl {

// Divides the VPLs of a cluster, at least two, into two that cost least: intensity times the area
// of the box times the measure of directions. Moves those of the first part to the front. Returns
// their number; 0 or all if no plane divides them.
size_t splitByOrientation(const VplLights& vpls, std::span<uint32_t> cluster);

}  // namespace bnvpl
