// What the readers of a glTF rely on, checked in one place.
#pragma once

#include <functional>
#include <string>

#include "scene/read/gltf/gltf_document.h"

namespace bnvpl {

// Throws GltfError where a property that we read has another type, is out of range, is missing
// though required, or is an index of something that is not there; and where the version is none of
// 2.x, or needs a reader of a later one. Factors and powers out of range are moved into it: warn()
// is told file, place and what is used, once a property. Properties that we do not read may be
// anything.
void requireValid(GltfDocument& document, const std::function<void(const std::string&)>& warn);

}  // namespace bnvpl
