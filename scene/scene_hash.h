#pragma once

#include "scene/scene.h"

namespace bnvpl {

// XXH3-64 of everything that light transport depends on: geometry, materials, textures, lights. It
// leaves out camera and film, since the VPLs of one view may light another.
uint64_t hashScene(const Scene& scene);

// XXH3-64 of a camera and its film.
uint64_t hashView(const Camera& camera, const Film& film);

}  // namespace bnvpl
