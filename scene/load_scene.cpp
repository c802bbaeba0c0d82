#include "scene/load_scene.h"

#include <algorithm>
#include <array>

#include "core/files.h"
#include "scene/read/toml/scene_toml.h"
#include "scene/scene_builder.h"

namespace bnvpl {

namespace {

struct Format {
  std::string_view extension;  // in lower case
  void (*read)(const fs::path& file, const Defines& defines, SceneBuilder& builder);
};
constexpr std::array kFormats{Format{".toml", readSceneToml}};

const Format& formatOf(const fs::path& file) {
  const std::string extension = lowerExtension(file);
  std::string known;
  for (const Format& format : kFormats) {
    if (format.extension == extension) return format;
    known += (known.empty() ? "" : ", ") + std::string(format.extension);
  }
  std::string problem = "is no scene file; scenes are read from " + known;
  if (extension == ".obj") problem += ", whose [[mesh]] names an OBJ";
  throw InputError(file, problem);
}

}  // namespace

const std::string* Defines::find(const std::string& name) const {
  const auto it = values_.find(name);
  if (it == values_.end()) return nullptr;
  it->second.used = true;
  return &it->second.value;
}

std::vector<std::string> Defines::unused() const {
  std::vector<std::string> names;
  for (const auto& [name, define] : values_) {
    if (!define.used) names.push_back(name);
  }
  return names;
}

Scene loadScene(const fs::path& path, const Defines& defines) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored))
    throw InputError(path, "is a folder; name the scene.toml in it");
  const Format& format = formatOf(path);
  SceneBuilder builder(path);
  format.read(path, defines, builder);
  return builder.finish();
}

}  // namespace bnvpl
