// Reads a scene.toml with the meshes and images that it names. docs/scene-format.md describes it.
#pragma once

#include "scene/builder/scene_builder.h"
#include "scene/load_scene.h"

namespace bnvpl {

// Throws InputError with file, line, section, problem and remedy.
void readSceneToml(const fs::path& file, const Defines& defines, SceneBuilder& builder);

}  // namespace bnvpl
