// Compares materials of two scenes.
#pragma once

#include "scene/scene.h"

namespace bnvpl {

struct MaterialOf {
  const Scene& scene;
  uint32_t number;
  const Material& operator*() const { return scene.materials[number]; }
};

// Compares parameters, and textures by their values at some points; ignores names.
bool sameMaterial(const MaterialOf& material, const MaterialOf& again);

}  // namespace bnvpl
