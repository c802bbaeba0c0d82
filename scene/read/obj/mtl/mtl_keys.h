// The keys that the materials of a library state, since tinyobjloader hides absent ones behind
// defaults, and the program that wrote them, on which their meaning depends.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "scene/read/obj/tinyobj.h"

namespace bnvpl {

struct MtlKeys {
  std::set<std::string, std::less<>> keys;
  std::vector<std::string> notes;  // what of its lines is ignored: MtlNotes
  bool blender = false;            // the library says that Blender wrote it
  // Ns of roughness 0; Blender's exporter in Python (2.8 to 3.2) wrote 900.
  float smoothExponent = 1000.0f;
  size_t line = 0;  // where the material begins

  bool has(std::string_view key) const { return keys.contains(key); }
  // Whether it is read as metallic-roughness, else as Phong, mirror or glass
  // (docs/scene-format.md).
  bool metallicRoughness() const;
};

// Whether the material is glass by its `illum` and `Ni`. Maya writes illum 4 and Ni 1 for whatever
// is opaque, and an index of 1 refracts nothing.
bool isGlass(const tinyobj::material_t& in, const MtlKeys& keys);

// The keys by material name; the first of a name counts. `library` is made by logicalLines().
std::map<std::string, MtlKeys> mtlKeys(std::string_view library);

}  // namespace bnvpl
