// Scene files -> Scene. A format is a folder of scene/read/ and one line of the list in
// load_scene.cpp.
#pragma once

#include <initializer_list>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "scene/scene.h"

namespace bnvpl {

// Values for ${NAME} in file names of a scene file; environment variables are asked second.
// Remembers which were asked for; of one thread.
class Defines {
 public:
  Defines(std::initializer_list<std::pair<std::string, std::string>> values = {}) {
    for (const auto& [name, value] : values) set(name, value);
  }
  void set(const std::string& name, const std::string& value) { values_[name] = {value}; }
  // Null where there is none of that name.
  const std::string* find(const std::string& name) const;
  // Names that no find() asked for.
  std::vector<std::string> unused() const;

 private:
  struct Define {
    std::string value;
    mutable bool used = false;
  };
  std::map<std::string, Define> values_;
};

// Reads a scene and everything that it names; the extension says the format. What could be
// repaired is in Scene::warnings, and goes to `onWarning` as it arises: what an error follows is
// nowhere else. Throws InputError with file, line where there is one, problem and cure; MemoryError
// or std::bad_alloc when it does not fit.
Scene loadScene(const fs::path& path, const Defines& defines = {}, const OnWarning& onWarning = {});

}  // namespace bnvpl
