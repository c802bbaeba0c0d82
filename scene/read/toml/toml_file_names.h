// Resolves file names in a scene.toml.
#pragma once

#include "scene/load_scene.h"
#include "scene/read/toml/toml_section.h"

namespace bnvpl {

// Expands ${NAME} and resolves relative names against the scene's folder. Borrows `defines`.
class FileNames {
 public:
  FileNames(const fs::path& sceneFile, const Defines& defines)
      : folder_(sceneFile.parent_path()), defines_(defines) {}

  const Defines& defines() const { return defines_; }
  fs::path resolve(const TomlSection& section, const char* key) const {
    return (folder_ / expand(section, key)).lexically_normal();
  }

 private:
  std::string expand(const TomlSection& section, const char* key) const;

  fs::path folder_;
  const Defines& defines_;
};

}  // namespace bnvpl
