// Checks the extensions of a glTF.
#pragma once

#include "scene/read/gltf/gltf_document.h"
#include "scene/scene_builder.h"

namespace bnvpl {

// Throws GltfError for an unknown extension that the file requires; warns about other unknown ones.
void checkExtensions(const GltfDocument& document, SceneBuilder& builder);

}  // namespace bnvpl
