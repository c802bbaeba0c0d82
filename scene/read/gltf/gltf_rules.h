// What the readers of a glTF rely on, checked in one place.
#pragma once

#include "scene/read/gltf/gltf_document.h"

namespace bnvpl {

// Throws GltfError where a property that we read has another type, is out of range, is missing
// though required, or is an index of something that is not there; and where the version is none of
// 2.x. Properties that we do not read may be anything.
void requireValid(const GltfDocument& document);

}  // namespace bnvpl
