// OBJ and MTL files -> meshes, materials and textures of a scene.
#pragma once

#include "scene/scene_builder.h"

namespace bnvpl {

// Adds one OBJ. `materials` replaces the libraries that the OBJ names; empty: those are used.
// Throws InputError when a file cannot be read at all; what can be repaired is a warning.
void loadObj(const fs::path& obj, const fs::path& materials, const Affine& transform,
             SceneBuilder& builder);

}  // namespace bnvpl
