// Converts the materials of a glTF.
#pragma once

#include <vector>

#include "scene/read/gltf/primitives.h"

namespace bnvpl {

// Adds the materials that meshes use, and the specification's default material if a primitive has
// none. Returns the `surfaces` of readPrimitives().
std::vector<GltfSurface> addGltfMaterials(const GltfModel& model, SceneBuilder& builder);

}  // namespace bnvpl
