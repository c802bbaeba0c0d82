// Tangents, and the shading normals of relief: normal maps and bump maps.
#pragma once

#include "transport/rays.h"

namespace bnvpl {

// Sets the tangent of a hit, and bends its shading normals, that of the surface and that of its
// clearcoat, by the material's reliefs; for a hit that
// is otherwise complete, of a triangle with texture coordinates at all corners. The shading normal
// stays in the hemisphere of ng, at least kMinRelief above the surface, so that the factor of
// photons keeps bounded. The relief is that of the front: seen from behind, what stood out goes in.
inline constexpr float kMinRelief = 0.05f;  // cosine
void applyRelief(const Scene& scene, const Triangle& triangle, SurfacePoint& hit);

}  // namespace bnvpl
