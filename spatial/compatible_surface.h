// Which points lie on compatible surfaces. Elimination, where such points compete, and estimation,
// where they may receive a photon's flux, share the definition, so that an eliminated candidate's
// neighbour can replace it.
#pragma once

#include "core/vec3.h"

namespace bnvpl {

// Normals may differ by 60 degrees. This separates the two sides of a wall, and the walls of a
// corner, but not mouldings, columns and curtains; tighter limits leave many photon hits without a
// VPL.
inline constexpr float kMinNormalDot = 0.5f;
// Max distance of a point from the other's tangent plane, relative to the radius of the query.
inline constexpr float kPlaneFactor = 0.5f;

// True if the dot product of the unit normals is at least minNormalDot, and each point lies within
// planeTolerance (world units) of the other's tangent plane. Bitwise symmetric in A and B.
inline bool compatibleSurfaces(Vec3 positionA, Vec3 normalA, Vec3 positionB, Vec3 normalB,
                               float planeTolerance, float minNormalDot = kMinNormalDot) {
  const Vec3 offset = positionB - positionA;
  return dot(normalA, normalB) >= minNormalDot &&
         std::fabs(dot(offset, normalA)) <= planeTolerance &&
         std::fabs(dot(offset, normalB)) <= planeTolerance;
}

}  // namespace bnvpl
