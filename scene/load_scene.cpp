#include "scene/load_scene.h"

#include <algorithm>
#include <array>

#include "core/files.h"
#include "scene/read/gltf/load_gltf.h"
#include "scene/read/pbrt/read_pbrt.h"
#include "scene/read/toml/scene_toml.h"
#include "scene/scene_builder.h"

namespace bnvpl {

namespace {

struct Format {
  std::string_view extension;  // in lower case
  void (*read)(const fs::path& file, const Defines& defines, SceneBuilder& builder);
};
constexpr std::array kFormats{Format{".toml", readSceneToml}, Format{".pbrt", readScenePbrt},
                              Format{".pbrt.gz", readScenePbrt}, Format{".gltf", readGltf},
                              Format{".glb", readGltf}};

const Format& formatOf(const fs::path& file) {
  std::string name = file.filename().string(), known;
  for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  for (const Format& format : kFormats) {
    if (name.ends_with(format.extension)) return format;
    known += (known.empty() ? "" : ", ") + std::string(format.extension);
  }
  std::string problem = "is no scene file; scenes are read from " + known;
  if (name.ends_with(".obj")) problem += "; the [[mesh]] of a .toml names an OBJ";
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

Scene loadScene(const fs::path& path, const Defines& defines, const OnWarning& onWarning) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored))
    throw InputError(path, "is a folder; name the scene.toml in it");
  const Format& format = formatOf(path);
  SceneBuilder builder(path, onWarning);
  format.read(path, defines, builder);
  return builder.finish();
}

}  // namespace bnvpl
