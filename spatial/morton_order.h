// Orders points so that those near in space are near in memory.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec3.h"

namespace bnvpl {

// Indices of the points along a Morton curve of 1024 cells per axis of their bounding box; points
// of the same cell keep their order.
std::vector<uint32_t> mortonOrder(std::span<const Vec3> points);

}  // namespace bnvpl
