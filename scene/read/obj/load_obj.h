// Reads OBJ and MTL files into the meshes, materials and textures of a scene.
#pragma once

#include "scene/builder/scene_builder.h"
#include "scene/load_scene.h"

namespace bnvpl {

// Adds one OBJ. `materials`, unless empty, replaces the libraries that the OBJ names. Throws
// InputError if a file cannot be read at all; repairs give a warning.
void loadObj(const fs::path& obj, const fs::path& materials, const Affine& transform,
             SceneBuilder& builder);

// Adds an OBJ that is a scene of its own.
void readSceneObj(const fs::path& file, const Defines& defines, SceneBuilder& builder);

}  // namespace bnvpl
