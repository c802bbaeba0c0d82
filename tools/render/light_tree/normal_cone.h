// Cones of directions.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/sampling.h"

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

// Smallest cone that contains both cones, slightly wider despite rounding. The angle between the
// axes comes from atan2, as acos tells equal axes apart where their cosine rounds to less than 1.
inline NormalCone merged(const NormalCone& a, const NormalCone& b) {
  constexpr float kMargin = 1e-3f;
  constexpr float kAlike = 1e-6f;  // axes that differ by rounding
  const NormalCone &wide = a.cosHalfAngle <= b.cosHalfAngle ? a : b, &narrow = &wide == &a ? b : a;
  const float wideAngle = std::acos(wide.cosHalfAngle),
              narrowAngle = std::acos(narrow.cosHalfAngle);
  const float cosine = dot(wide.axis, narrow.axis);
  const Vec3 sideways = narrow.axis - wide.axis * cosine;
  const float between = std::atan2(length(sideways), cosine);
  if (between + narrowAngle <= wideAngle + kAlike) return wide;
  const float angle = 0.5f * (wideAngle + narrowAngle + between);
  if (angle >= kPi || between > kPi - kAlike) return {wide.axis, -1.0f};
  const float turn = angle - wideAngle;
  return {normalize(wide.axis * std::cos(turn) + normalize(sideways) * std::sin(turn)),
          std::cos(std::min(kPi, angle + kMargin))};
}

}  // namespace bnvpl
