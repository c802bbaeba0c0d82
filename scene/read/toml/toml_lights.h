// [[light]] of a scene.toml.
#pragma once

#include "scene/read/toml/toml_file_names.h"
#include "scene/scene_builder.h"

namespace bnvpl {

// Throws InputError.
void readTomlLights(const fs::path& file, const toml::table& root, const FileNames& names,
                    SceneBuilder& builder);

}  // namespace bnvpl
