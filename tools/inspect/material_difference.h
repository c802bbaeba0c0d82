// Whether materials of two scenes are the same.
#pragma once

#include "scene/scene.h"

namespace bnvpl {

struct MaterialOf {
  const Scene& scene;
  uint32_t number;
  const Material& operator*() const { return scene.materials[number]; }
};

// By their parameters, textures by their values at some places. `again` has the name that
// write_scene.h gives.
bool sameMaterial(const MaterialOf& material, const MaterialOf& again);

}  // namespace bnvpl
