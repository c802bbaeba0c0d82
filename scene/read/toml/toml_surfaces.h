// [[texture]] and [[material]] of a scene.toml, for materials that MTL cannot express.
#pragma once

#include <map>
#include <set>

#include "scene/builder/scene_builder.h"
#include "scene/read/toml/toml_file_names.h"

namespace bnvpl {

// Must be read before the meshes, whose materials it replaces. Borrows its arguments. All functions
// throw InputError.
class TomlSurfaces {
 public:
  TomlSurfaces(const fs::path& file, const toml::table& root, const FileNames& names,
               SceneBuilder& builder);
  // Warns about materials that no mesh uses. Call it after the meshes are read.
  void warnOfUnused() const;

 private:
  void readTexture(const TomlSection& s);
  void readMaterial(const toml::table& table);
  void readCommon(const TomlSection& s, Material& m) const;
  Relief readRelief(const TomlSection& s, const std::string& prefix) const;
  // The number of a texture or material defined above; kNone without the key.
  uint32_t texture(const TomlSection& s, const std::string& key) const;
  uint32_t material(const TomlSection& s, const char* key);

  const fs::path& file_;
  const FileNames& names_;
  SceneBuilder& builder_;
  std::map<std::string, uint32_t> textures_, materials_;  // numbers by name
  std::set<std::string> mixed_;                           // materials that mixes use
};

}  // namespace bnvpl
