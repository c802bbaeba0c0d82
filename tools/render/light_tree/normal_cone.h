// Cones of directions.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/vec3.h"

namespace bnvpl {

// All unit vectors whose cosine with the axis is at least cosHalfAngle.
struct NormalCone {
  Vec3 axis;
  float cosHalfAngle = 1.0f;
  float sinHalfAngle() const {  // the half angle is at most 90 degrees
    return cosHalfAngle <= 0.0f ? 1.0f
                                : std::sqrt(std::max(0.0f, 1.0f - cosHalfAngle * cosHalfAngle));
  }
};

// Smallest cone that contains both cones.
inline NormalCone merged(const NormalCone& a, const NormalCone& b) {
  const float ta = std::acos(a.cosHalfAngle), tb = std::acos(b.cosHalfAngle);
  const float between = std::acos(std::clamp(dot(a.axis, b.axis), -1.0f, 1.0f));
  const NormalCone& wide = ta >= tb ? a : b;
  const float wideAngle = std::max(ta, tb), narrowAngle = std::min(ta, tb);
  if (between + narrowAngle <= wideAngle) return wide;
  constexpr float kStraight = 3.14159265f;
  const float angle = 0.5f * (ta + tb + between);
  const Vec3& other = ta >= tb ? b.axis : a.axis;
  const Vec3 sideways = other - wide.axis * dot(wide.axis, other);
  if (angle >= kStraight || lengthSquared(sideways) < 1e-10f) return {wide.axis, -1.0f};
  const float turn = angle - wideAngle;
  // Slightly wider than exact, so that it stays a bound despite rounding.
  return {normalize(wide.axis * std::cos(turn) + normalize(sideways) * std::sin(turn)),
          std::cos(std::min(kStraight, angle + 1e-3f))};
}

}  // namespace bnvpl
