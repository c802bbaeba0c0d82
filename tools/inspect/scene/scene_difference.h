// Compares two scenes up to rounding.
#pragma once

#include <string>

#include "scene/scene.h"

namespace bnvpl {

// Compares a scene with itself after writing (write_scene.h) and reading: camera and film, lights,
// triangles with their materials, instances, extent. Names the first part that differs; empty:
// none.
std::string sceneDifference(const Scene& scene, const Scene& again);

}  // namespace bnvpl
