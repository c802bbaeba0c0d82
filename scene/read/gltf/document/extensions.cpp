#include "scene/read/gltf/document/extensions.h"

#include <algorithm>
#include <array>
#include <set>
#include <string_view>

namespace bnvpl {

namespace {

constexpr std::array<std::string_view, 14> kUnderstood{
    "EXT_mesh_gpu_instancing", "EXT_meshopt_compression", "KHR_draco_mesh_compression",
    "KHR_lights_punctual", "KHR_materials_clearcoat", "KHR_materials_emissive_strength",
    "KHR_materials_ior", "KHR_materials_specular", "KHR_materials_transmission",
    "KHR_materials_unlit", "KHR_mesh_quantization", "KHR_texture_transform",
    // These have no effect on the image:
    "KHR_xmp_json_ld", "KHR_materials_variants"};  // the default variant is rendered

constexpr size_t kLongestName = 80;  // that is shown

bool isUnderstood(const std::string& name) {
  return std::find(kUnderstood.begin(), kUnderstood.end(), name) != kUnderstood.end();
}

// Collects the names of the extensions that parts of the file have, listed or not.
void collectUsed(const nlohmann::json& json, std::set<std::string>& names) {
  if (!json.is_structured()) return;
  for (const auto& [key, value] : json.items()) {
    if (json.is_object() && key == "extras") continue;
    if (json.is_object() && key == "extensions" && value.is_object()) {
      for (const auto& [name, extension] : value.items()) names.insert(name);
    }
    collectUsed(value, names);
  }
}

}  // namespace

void checkExtensions(const GltfDocument& document, SceneBuilder& builder) {
  const auto namesOf = [&](const char* list) {
    const auto it = document.json.find(list);
    return it == document.json.end() ? std::vector<std::string>()
                                     : it->get<std::vector<std::string>>();
  };
  const std::vector<std::string> required = namesOf("extensionsRequired");
  for (size_t i = 0; i < required.size(); ++i) {
    if (isUnderstood(required[i])) continue;
    throw GltfError(document.file, "/extensionsRequired/" + std::to_string(i),
                    "the extension " + required[i] + " is not read; export without it");
  }
  const std::vector<std::string> listed = namesOf("extensionsUsed");
  std::set<std::string> used(listed.begin(), listed.end());
  collectUsed(document.json, used);
  for (const std::string& name : used) {
    if (isUnderstood(name)) continue;
    builder.warn(document.file.string() + ": the extension " +
                 onOneLine(name).substr(0, kLongestName) + " is ignored");
  }
}

}  // namespace bnvpl
