// Checks the extensions of a glTF.
#pragma once

#include "scene/builder/scene_builder.h"
#include "scene/read/gltf/document/gltf_document.h"

namespace bnvpl {

// Throws GltfError for an unknown extension that the file requires; warns about other unknown ones.
void checkExtensions(const GltfDocument& document, SceneBuilder& builder);

}  // namespace bnvpl
