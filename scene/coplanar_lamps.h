// Lamps that lie exactly in a wall: which of the two a ray meets is left to rounding, so that such
// a lamp would shine in part, and by the order of the faces.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace bnvpl {

// Moves emissive triangles of the world that lie in the plane of others, over which they extend, to
// the side on which they shine, by what rays are offset. Needs the bounds. Returns a warning for
// each pair of materials of which the lamp shines on both sides: it is left with the one of its
// winding.
std::vector<std::string> liftCoplanarLamps(Scene& scene);

}  // namespace bnvpl
