// [[mesh]] of a scene.toml: an OBJ, or all of another scene file.
#pragma once

#include "scene/builder/scene_builder.h"
#include "scene/read/toml/toml_file_names.h"

namespace bnvpl {

// Throws InputError, also if the file has no [[mesh]].
void readTomlMeshes(const fs::path& file, const toml::table& root, const FileNames& names,
                    SceneBuilder& builder);

}  // namespace bnvpl
