// Point and spot lights that lie in a surface. Rounding decides for each ray whether the surface
// hides such a light, so methods that reach it from different sides would disagree.
#pragma once

#include <string>

#include "scene/scene.h"

namespace bnvpl {

// Returns a warning that names the first light which lies nearer to a triangle than 2^-18 of the
// scene's size, about the offset of ray origins, and counts the others; empty if there is none.
// Needs Scene::bounds.
std::string lightsInSurfaces(const Scene& scene);

}  // namespace bnvpl
