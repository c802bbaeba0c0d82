// Reads scene files of pbrt-v4. docs/scenes.md says what is read and how.
#pragma once

#include "scene/builder/scene_builder.h"
#include "scene/load_scene.h"

namespace bnvpl {

// Reads a scene file, packed by gzip or not, and all files that it names. `defines` are unused: the
// format has no ${NAME}. Throws InputError.
void readScenePbrt(const fs::path& file, const Defines& defines, SceneBuilder& builder);

}  // namespace bnvpl
