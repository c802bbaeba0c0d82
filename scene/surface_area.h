#pragma once

#include "scene/scene.h"

namespace bnvpl {

// Area of all triangles, in scene units squared. Each instance counts, by the factor of its volume
// to the power 2/3, which is exact for transforms that keep angles.
double surfaceArea(const Scene& scene);

}  // namespace bnvpl
