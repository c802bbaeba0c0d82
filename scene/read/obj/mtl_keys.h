// Which fields the materials of a library state: tinyobjloader gives its defaults for those that
// are not there. And what wrote them, on which their meaning depends.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace bnvpl {

struct MtlKeys {
  std::set<std::string, std::less<>> keys;
  std::vector<std::string> notes;  // what of its lines is ignored: MtlNotes
  bool blender = false;            // the library says that Blender wrote it

  bool has(std::string_view key) const { return keys.contains(key); }
  // Read as roughness and metal (docs/scene-format.md); else as Phong, mirror or glass.
  bool metallicRoughness() const;
};

// By name, of the first material of each; of the lines that logicalLines() made.
std::map<std::string, MtlKeys> mtlKeys(std::string_view library);

}  // namespace bnvpl
