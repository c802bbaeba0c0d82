#include "scene/read/gltf/materials.h"

#include <algorithm>
#include <cmath>

namespace bnvpl {

std::vector<GltfSurface> addGltfMaterials(const GltfModel& model, SceneBuilder& builder) {
  std::vector<GltfSurface> out;
  for (const tinygltf::Material& from : model.parts().materials) {
    Material m;
    m.name = from.name;
    const auto& pbr = from.pbrMetallicRoughness;
    for (size_t i = 0; i < 3; ++i) {
      m.diffuse[i] = static_cast<float>(pbr.baseColorFactor[i] * (1.0 - pbr.metallicFactor));
      m.emission[i] = static_cast<float>(from.emissiveFactor[i]);
    }
    m.twoSidedEmission = from.doubleSided;
    out.push_back({builder.addMaterial(m), 0});
  }
  Material plain;
  plain.diffuse = Vec3(0.5f);
  out.push_back({builder.addMaterial(plain), 0});
  return out;
}

}  // namespace bnvpl
