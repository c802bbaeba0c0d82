// glTF 2.0, appendix B, with KHR_materials_ior, _specular, _clearcoat and _transmission (thin
// walls). alpha = roughness^2. The textures' expressions must select the channels: metallic Blue,
// roughness Green, specular Alpha, clearcoat Red, clearcoatRoughness Green, transmission Red.
#pragma once

#include "scene/models/parameters.h"

namespace bnvpl {

struct MetallicRoughnessModel {
  static constexpr const char* kName = "metallic_roughness";
  static constexpr uint32_t kHashId = 7;
  static constexpr uint32_t kLobes = 4;
  Colour baseColour{Vec3(1)};
  Scalar metallic{1.0f}, roughness{1.0f};
  // Disney's anisotropy: alpha is roughness^2 / a along increasing u and roughness^2 a across it,
  // a^2 = 1 - 0.9 anisotropy.
  Scalar anisotropy{0.0f};
  Scalar anisotropyTurns{0.0f};  // rotation of that direction in turns, anticlockwise from outside
  Scalar ior{1.5f};              // 0 means total reflection, as in KHR_materials_ior
  Scalar specular{1.0f};
  Colour specularColour{Vec3(1)};
  Scalar clearcoat{0.0f}, clearcoatRoughness{0.0f};
  Scalar transmission{0.0f};
};

template <Like<MetallicRoughnessModel> M, typename Fn>
void forEachField(M& m, const Fn& fn) {
  fn("base_colour", m.baseColour);
  fn("specular_colour", m.specularColour);
  fn("metallic", m.metallic);
  fn("roughness", m.roughness);
  fn("anisotropy", m.anisotropy);
  fn("ior", m.ior);
  fn("specular", m.specular);
  fn("clearcoat", m.clearcoat);
  fn("clearcoat_roughness", m.clearcoatRoughness);
  fn("transmission", m.transmission);
  fn("anisotropy_turns", m.anisotropyTurns);
}

}  // namespace bnvpl
