#include "scene/read/gltf/extensions.h"

#include <algorithm>
#include <array>
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

bool isUnderstood(const std::string& name) {
  return std::find(kUnderstood.begin(), kUnderstood.end(), name) != kUnderstood.end();
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
  for (const std::string& name : namesOf("extensionsUsed")) {
    if (!isUnderstood(name))
      builder.warn(document.file.string() + ": the extension " + name + " is ignored");
  }
}

}  // namespace bnvpl
