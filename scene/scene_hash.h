#pragma once

#include "scene/scene.h"

namespace bnvpl {

// XXH3-64 over what light transport depends on: geometry, materials, textures, lights. The camera
// and the film are left out: the VPLs of one view may light another.
uint64_t hashScene(const Scene& scene);

// XXH3-64 of a camera and its film.
uint64_t hashView(const Camera& camera, const Film& film);

}  // namespace bnvpl
