// Validates everything that the readers of a glTF rely on.
#pragma once

#include <functional>
#include <string>

#include "scene/read/gltf/document/gltf_document.h"

namespace bnvpl {

// Throws GltfError if a property that is read has the wrong type, is out of range, is missing
// though required, or is an index without a target; also if the version is not 2.x or requires a
// later reader. Factors and powers out of range are clamped: warn() receives file, place and the
// value used, once per property. Properties that are not read may be anything.
void requireValid(GltfDocument& document, const std::function<void(const std::string&)>& warn);

}  // namespace bnvpl
