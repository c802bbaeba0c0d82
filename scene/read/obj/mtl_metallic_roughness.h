// Materials of MTL that state roughness and metal, or that Blender wrote: its Principled BSDF.
#pragma once

#include <functional>

#include "scene/read/obj/mtl_maps.h"

namespace bnvpl {

// The model, and how much of it is seen through. `warn` gets problem and what becomes of it.
void readMetallicRoughness(const tinyobj::material_t& in, const MtlKeys& keys, const MtlMaps& maps,
                           SceneBuilder& builder,
                           const std::function<void(const std::string&)>& warn, Material& m);

}  // namespace bnvpl
