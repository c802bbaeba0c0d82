#include "scene/read/obj/mtl/mtl_keys.h"

#include <algorithm>
#include <array>

#include "scene/read/obj/obj_text.h"

namespace bnvpl {

bool MtlKeys::metallicRoughness() const {
  constexpr std::array<std::string_view, 9> kKeys{"Pr",    "Pm",     "Ps",     "Pc",    "Pcr",
                                                  "aniso", "anisor", "map_Pr", "map_Pm"};
  return blender || std::any_of(kKeys.begin(), kKeys.end(), [&](auto key) { return has(key); });
}

bool isGlass(const tinyobj::material_t& in, const MtlKeys& keys) {
  const bool refracts = !keys.has("Ni") || in.ior > 1.0;
  return in.illum == 6 || in.illum == 7 || ((in.illum == 4 || in.illum == 9) && refracts);
}

std::map<std::string, MtlKeys> mtlKeys(std::string_view library) {
  std::map<std::string, MtlKeys> out;
  MtlKeys unnamed;
  MtlKeys* keys = &unnamed;
  const bool blender = library.starts_with("# Blender ");
  const bool byPython = library.starts_with("# Blender MTL File");
  while (!library.empty()) {
    const size_t end = std::min(library.find('\n'), library.size());
    const std::string_view line = trimmed(library.substr(0, end));
    library.remove_prefix(std::min(end + 1, library.size()));
    const size_t blank = std::min(line.find_first_of(" \t\r"), line.size());
    const std::string_view key = line.substr(0, blank);
    if (key == "newmtl") {
      const auto [it, isNew] = out.try_emplace(firstLine(std::string(trimmed(line.substr(blank)))));
      keys = isNew ? &it->second : &unnamed;
      keys->blender = blender;
      if (byPython) keys->smoothExponent = 900.0f;
    } else if (!key.empty() && key[0] != '#') {
      keys->keys.emplace(key);
    }
  }
  return out;
}

}  // namespace bnvpl
