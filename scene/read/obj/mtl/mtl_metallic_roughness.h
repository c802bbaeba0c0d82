// MTL materials that state roughness or metallic keys, or that Blender wrote (Principled BSDF).
#pragma once

#include <functional>

#include "scene/read/obj/mtl/mtl_maps.h"

namespace bnvpl {

// Sets the model of `m` and its transparency. `warn` receives each problem and its consequence.
void readMetallicRoughness(const tinyobj::material_t& in, const MtlKeys& keys, const MtlMaps& maps,
                           SceneBuilder& builder,
                           const std::function<void(const std::string&)>& warn, Material& m);

}  // namespace bnvpl
