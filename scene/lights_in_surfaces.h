// Point and spot lights that lie in a surface. Rounding decides for each ray whether the surface
// hides such a light, so methods that reach it from different sides would disagree.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace bnvpl {

// Returns a warning that names the lights that lie nearer to a triangle than ray origins are
// offset. Needs Scene::bounds.
std::vector<std::string> lightsInSurfaces(const Scene& scene);

}  // namespace bnvpl
