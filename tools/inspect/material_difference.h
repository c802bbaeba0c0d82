// Whether materials of two scenes are the same.
#pragma once

#include "scene/scene.h"

namespace bnvpl {

struct MaterialOf {
  const Scene& scene;
  uint32_t number;
  const Material& operator*() const { return scene.materials[number]; }
};

// By their parameters, and textures by their values at some places; names do not count.
bool sameMaterial(const MaterialOf& material, const MaterialOf& again);

}  // namespace bnvpl
