// Turns a Description into a scene: interprets types and parameters.
#pragma once

#include "scene/builder/scene_builder.h"
#include "scene/read/pbrt/syntax/description.h"

namespace bnvpl::pbrt {

// `folder` is the folder of the scene file. Throws InputError.
void build(const Description& description, const fs::path& folder, Notes& notes,
           SceneBuilder& builder);

}  // namespace bnvpl::pbrt
