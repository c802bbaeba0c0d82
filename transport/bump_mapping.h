// Tangents, and shading normals from normal maps and bump maps.
#pragma once

#include "transport/accelerator/accelerator.h"

namespace bnvpl {

inline constexpr float kMinShadingCosine = 0.05f;  // cosine of shading normals with ng

// Sets the tangent of a hit, and perturbs the shading normals of surface and clearcoat by the
// material's reliefs. The hit must be complete otherwise, and its triangle have texture coordinates
// at all corners. Shading normals keep a cosine with ng of at least kMinShadingCosine, and so stay on
// its side. Reliefs refer to the front: seen from behind, bumps are dents.
void applyRelief(const Scene& scene, const Triangle& triangle, SurfacePoint& hit);

}  // namespace bnvpl
