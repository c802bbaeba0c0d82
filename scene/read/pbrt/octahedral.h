// pbrt's environment images, which map the sphere to a square with areas in proportion to solid
// angle. Petrik Clarberg, "Fast Equal-Area Mapping of the (Hemi)Sphere using SIMD", 2008.
#pragma once

#include "scene/affine.h"
#include "scene/textures/texture.h"

namespace bnvpl::pbrt {

// Maps a unit direction to the square [0,1]^2; (0.5, 0.5) is +z, the corners are -z.
std::array<double, 2> squareOf(const FilePoint& direction);

// Resamples a square image to a latitude-longitude image of world directions
// (transport/lights/light_shape.h) of equal height. The mean over the sphere is kept in each
// channel.
EnvironmentImage latLongOf(const EnvironmentImage& square, const Affine& lightFromWorld);

}  // namespace bnvpl::pbrt
