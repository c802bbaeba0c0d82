// Whether two scenes are one and the same but for rounding.
#pragma once

#include <string>

#include "scene/scene.h"

namespace bnvpl {

// Compares a scene with the one that was read from what write_scene.h made of it, part by part:
// camera and film, triangles with their materials, instances, lights. Names the first part that
// differs; empty: none.
std::string sceneDifference(const Scene& scene, const Scene& again);

}  // namespace bnvpl
