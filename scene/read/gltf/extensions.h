// Which extensions of glTF are understood.
#pragma once

#include "scene/read/gltf/gltf_document.h"
#include "scene/scene_builder.h"

namespace bnvpl {

// Throws GltfError for an extension that the file requires and that we do not know; warns of those
// that it uses and that are ignored.
void checkExtensions(const GltfDocument& document, SceneBuilder& builder);

}  // namespace bnvpl
