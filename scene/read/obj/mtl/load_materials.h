// Converts materials of MTL libraries. docs/scene-format.md says how their fields are read.
#pragma once

#include "scene/builder/scene_builder.h"
#include "scene/read/obj/mtl/mtl_keys.h"
#include "scene/read/obj/tinyobj.h"

namespace bnvpl {

// The source of a material. Textures are searched beside the library, then beside the OBJ.
struct MaterialSource {
  const fs::path& library;
  const fs::path& obj;
  const MtlKeys& keys;  // keys that the material states
};

// Starts to decode the material's textures while the mesh is read.
void expectTextures(const MaterialSource& from, const tinyobj::material_t& in,
                    SceneBuilder& builder);

// The beginning of warnings about a material: "room.mtl:7: material 'wall': ".
std::string whereIs(const MaterialSource& from, const tinyobj::material_t& in);

// Returns the material's number in the scene.
uint32_t addMaterial(const MaterialSource& from, tinyobj::material_t in, SceneBuilder& builder);

}  // namespace bnvpl
