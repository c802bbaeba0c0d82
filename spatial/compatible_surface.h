// Which points belong to a compatible surface. One definition for elimination (who competes)
// and for estimation (who may receive a photon's energy): whoever lost to a neighbour can be
// replaced by it.
#pragma once

#include "core/vec3.h"

namespace bnvpl {

// Normals may differ by 60 degrees: the two sides of a wall and its corners are apart, while
// mouldings, columns and curtains stay together (tighter limits left many hits without any
// partner).
inline constexpr float kMinNormalDot = 0.5f;
// How far a point may lie off the other's tangent plane, as a share of the radius of the query.
inline constexpr float kPlaneFactor = 0.5f;

// True when the unit normals agree (dot product at least minNormalDot) and each point lies within
// planeTolerance (world units) of the other's tangent plane. Bitwise symmetric in a and b.
inline bool compatibleSurfaces(Vec3 positionA, Vec3 normalA, Vec3 positionB, Vec3 normalB,
                               float planeTolerance, float minNormalDot = kMinNormalDot) {
  const Vec3 offset = positionB - positionA;
  return dot(normalA, normalB) >= minNormalDot &&
         std::fabs(dot(offset, normalA)) <= planeTolerance &&
         std::fabs(dot(offset, normalB)) <= planeTolerance;
}

}  // namespace bnvpl
