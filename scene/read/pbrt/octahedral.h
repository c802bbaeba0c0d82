// pbrt's environment images: the sphere on a square, each part in proportion to its solid angle.
// Petrik Clarberg, "Fast Equal-Area Mapping of the (Hemi)Sphere using SIMD", 2008.
#pragma once

#include "scene/affine.h"
#include "scene/textures/texture.h"

namespace bnvpl::pbrt {

// A unit direction's place in the square [0,1]^2; (0.5, 0.5) is +z, the corners are -z.
std::array<double, 2> squareOf(const FilePoint& direction);

// As a latitude-longitude image of world directions (transport/light_shape.h), of about as many
// texels. What arrives from the whole sphere stays the same in each channel. The image is square.
EnvironmentImage latLongOf(const EnvironmentImage& square, const Affine& lightFromWorld);

}  // namespace bnvpl::pbrt
