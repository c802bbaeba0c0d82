#pragma once

#include "scene/scene.h"

namespace bnvpl {

// Factor of areas by an instance's transform: that of volumes to the power 2/3, which is exact for
// transforms that keep angles.
double areaFactor(const Instance& instance);

// Area of all triangles, in scene units squared, with those of each instance.
double surfaceArea(const Scene& scene);

}  // namespace bnvpl
