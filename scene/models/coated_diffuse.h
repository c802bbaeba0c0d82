// Lambertian base below a dielectric coat; pbrt's `coateddiffuse` without a medium.
#pragma once

#include "scene/models/parameters.h"

namespace bnvpl {

struct CoatedDiffuseModel {
  static constexpr const char* kName = "coated_diffuse";
  static constexpr uint32_t kHashId = 5;
  static constexpr uint32_t kLobes = 2;
  Colour reflectance{Vec3(0.5f)};  // albedo of the base without the coat
  Scalar ior{1.5f};                // index of the coat
  Roughness roughness{Scalar(0.0f)};
  Scalar thickness{0.0f};  // the coat's, in mean free paths: it absorbs, as in pbrt
};

template <Like<CoatedDiffuseModel> M, typename Fn>
void forEachField(M& m, const Fn& fn) {
  fn("reflectance", m.reflectance);
  fn("ior", m.ior);
  forEachField(m.roughness, kRoughnessNames, fn);
  fn("thickness", m.thickness);
}

}  // namespace bnvpl
