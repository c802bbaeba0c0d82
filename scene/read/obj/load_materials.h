// Materials of MTL libraries -> those of a scene. docs/scene-format.md says how fields are read.
#pragma once

#include "scene/read/obj/mtl_keys.h"
#include "scene/read/obj/tinyobj.h"
#include "scene/scene_builder.h"

namespace bnvpl {

// Where a material comes from. Textures are looked for beside the library, then beside the OBJ.
struct MaterialSource {
  const fs::path& library;
  const fs::path& obj;
  const MtlKeys& keys;  // that the material states
};

// Textures that will be wanted, to be read while the mesh is.
void expectTextures(const MaterialSource& from, const tinyobj::material_t& in,
                    SceneBuilder& builder);

// Returns the material's number in the scene.
uint32_t addMaterial(const MaterialSource& from, tinyobj::material_t in, SceneBuilder& builder);

}  // namespace bnvpl
