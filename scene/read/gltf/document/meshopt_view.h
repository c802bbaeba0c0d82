// Decodes EXT_meshopt_compression. Nothing else uses meshoptimizer.
#pragma once

#include <string_view>

#include "scene/read/gltf/document/gltf_document.h"

namespace bnvpl {

// Decompresses the bytes of a buffer view. `extension` is the view's extension, validated by
// requireValid(); `pointer` names it in messages. Throws GltfError.
std::string decodeMeshopt(const fs::path& file, const std::string& pointer,
                          const nlohmann::json& extension, std::string_view compressed);

}  // namespace bnvpl
