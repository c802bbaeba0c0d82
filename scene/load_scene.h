// Reads scene files. A format is a folder of scene/read/ and one line of the list in
// load_scene.cpp.
#pragma once

#include <initializer_list>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "scene/scene.h"

namespace bnvpl {

// Values of ${NAME} in the file names of a scene file; they take precedence over environment
// variables. Records which of them were used; not thread-safe.
class Defines {
 public:
  Defines(std::initializer_list<std::pair<std::string, std::string>> values = {}) {
    for (const auto& [name, value] : values) set(name, value);
  }
  void set(const std::string& name, const std::string& value) { values_[name] = {value}; }
  // Returns null if the name has no value; else marks it as used.
  const std::string* find(const std::string& name) const;
  // Names that no find() has used.
  std::vector<std::string> unused() const;

 private:
  struct Define {
    std::string value;
    mutable bool used = false;
  };
  std::map<std::string, Define> values_;
};

class SceneBuilder;

// Whether the extension is that of a format that readSceneFile() reads.
bool isSceneFile(const fs::path& path);
// Adds a scene file and all files that it names, by its extension. Throws InputError.
void readSceneFile(const fs::path& path, const Defines& defines, SceneBuilder& builder);

// Reads a scene and all files that it names; the extension decides the format. Repairs are reported
// in Scene::warnings and, as they occur, to `onWarning`, which alone receives those that precede an
// error. Throws InputError with file, line (if any), problem and remedy; MemoryError or
// std::bad_alloc if the scene does not fit.
Scene loadScene(const fs::path& path, const Defines& defines = {}, const OnWarning& onWarning = {});

}  // namespace bnvpl
