// EXT_meshopt_compression. The one use of meshoptimizer.
#pragma once

#include <string_view>

#include "scene/read/gltf/gltf_document.h"

namespace bnvpl {

// The bytes of a buffer view from its compressed ones. `extension` is the view's, as gltf_rules.h
// checks it; `pointer` names it in messages. Throws GltfError.
std::string decodeMeshopt(const fs::path& file, const std::string& pointer,
                          const nlohmann::json& extension, std::string_view compressed);

}  // namespace bnvpl
