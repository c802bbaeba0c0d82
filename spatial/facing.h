// Classifies normals by the nearest of the six axis directions.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/vec3.h"

namespace bnvpl {

inline constexpr uint32_t kFacings = 6;

inline uint32_t facingOf(Vec3 n) {
  const float x = std::fabs(n.x), y = std::fabs(n.y), z = std::fabs(n.z);
  const uint32_t axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
  return 2 * axis + (n[axis] < 0.0f ? 1 : 0);
}
// The unit vector of a facing.
inline Vec3 axisOf(uint32_t facing) {
  Vec3 axis;
  axis[facing / 2] = facing % 2 == 0 ? 1.0f : -1.0f;
  return axis;
}

}  // namespace bnvpl
