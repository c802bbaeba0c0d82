// Lambertian reflection; pbrt's `diffuse`.
#pragma once

#include "scene/models/parameters.h"

namespace bnvpl {

struct DiffuseModel {
  static constexpr const char* kName = "diffuse";
  static constexpr uint32_t kHashId = 1;
  static constexpr uint32_t kLobes = 1;
  Colour reflectance{Vec3(0.5f)};
};

template <Like<DiffuseModel> M, typename Fn>
void forEachField(M& m, const Fn& fn) {
  fn("reflectance", m.reflectance);
}

}  // namespace bnvpl
