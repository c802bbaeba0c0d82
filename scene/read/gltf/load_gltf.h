// Reads glTF 2.0 (.gltf and .glb) with the buffers and images that it names. docs/scenes.md says
// what is read and how.
#pragma once

#include "scene/builder/scene_builder.h"
#include "scene/load_scene.h"

namespace bnvpl {

// Throws InputError with file, JSON pointer, problem and remedy. Defines are unused.
void readGltf(const fs::path& file, const Defines&, SceneBuilder& builder);

}  // namespace bnvpl
