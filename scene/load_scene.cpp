#include "scene/load_scene.h"

#include <algorithm>
#include <array>
#include <cctype>

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
  std::string extension = file.extension().string(), known;
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
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
  const Format& format = formatOf(path);
  SceneBuilder builder(path);
  format.read(path, defines, builder);
  return builder.finish();
}

}  // namespace bnvpl
