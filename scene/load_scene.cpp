#include "scene/load_scene.h"

#include <algorithm>
#include <array>

#include "core/files.h"
#include "scene/builder/scene_builder.h"
#include "scene/read/gltf/load_gltf.h"
#include "scene/read/obj/load_obj.h"
#include "scene/read/pbrt/read_pbrt.h"
#include "scene/read/toml/scene_toml.h"

namespace bnvpl {

namespace {

struct Format {
  std::string_view extension;  // in lower case
  void (*read)(const fs::path& file, const Defines& defines, SceneBuilder& builder);
};
constexpr std::array kFormats{Format{".toml", readSceneToml},    Format{".pbrt", readScenePbrt},
                              Format{".pbrt.gz", readScenePbrt}, Format{".gltf", readGltf},
                              Format{".glb", readGltf},          Format{".obj", readSceneObj}};

// Returns null for other files.
const Format* formatOf(const fs::path& file) {
  const std::string name = lowered(file.filename().string());
  const auto known = std::ranges::find_if(
      kFormats, [&](const Format& format) { return name.ends_with(format.extension); });
  return known == kFormats.end() ? nullptr : &*known;
}

}  // namespace

bool isSceneFile(const fs::path& path) { return formatOf(path) != nullptr; }

void readSceneFile(const fs::path& path, const Defines& defines, SceneBuilder& builder) {
  if (const Format* format = formatOf(path)) return format->read(path, defines, builder);
  std::string known;
  for (const Format& format : kFormats)
    known += (known.empty() ? "" : ", ") + std::string(format.extension);
  throw InputError(path, "is no scene file; scenes are read from " + known);
}

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
  SceneBuilder builder(path, onWarning);
  readSceneFile(path, defines, builder);
  return builder.finish();
}

}  // namespace bnvpl
