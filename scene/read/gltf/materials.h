// Materials of a glTF.
#pragma once

#include <vector>

#include "scene/read/gltf/primitives.h"

namespace bnvpl {

// Adds the file's materials that its meshes use, and the specification's default material where a
// primitive has none. The result is what readPrimitives() asks for.
std::vector<GltfSurface> addGltfMaterials(const GltfModel& model, SceneBuilder& builder);

}  // namespace bnvpl
