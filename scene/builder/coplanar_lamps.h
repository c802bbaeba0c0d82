// Lamps (emissive triangles) that lie exactly in the plane of a wall. Rounding and the order of the
// faces decide which of the two a ray hits, so such a lamp would appear in patches.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace bnvpl {

// Moves emissive triangles of the world that overlap other triangles in their plane towards the
// side of their winding, by the offset of ray origins. Needs Scene::bounds. Returns a warning for
// each pair of materials whose lamp emits on both sides: only the side of the winding shows.
std::vector<std::string> liftCoplanarLamps(Scene& scene);

}  // namespace bnvpl
