// Description -> scene: what types and parameters mean.
#pragma once

#include "scene/read/pbrt/description.h"
#include "scene/scene_builder.h"

namespace bnvpl::pbrt {

// `folder` is that of the scene's file. Throws InputError.
void build(const Description& description, const fs::path& folder, Notes& notes,
           SceneBuilder& builder);

}  // namespace bnvpl::pbrt
