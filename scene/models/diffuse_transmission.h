// Lambertian reflection and transmission; pbrt's `diffusetransmission`. Where reflectance +
// transmittance exceeds 1, both are scaled down.
#pragma once

#include "scene/models/parameters.h"

namespace bnvpl {

struct DiffuseTransmissionModel {
  static constexpr const char* kName = "diffuse_transmission";
  static constexpr uint32_t kHashId = 2;
  static constexpr uint32_t kLobes = 2;
  Colour reflectance{Vec3(0.25f)}, transmittance{Vec3(0.25f)};
};

template <Like<DiffuseTransmissionModel> M, typename Fn>
void forEachField(M& m, const Fn& fn) {
  fn("reflectance", m.reflectance);
  fn("transmittance", m.transmittance);
}

}  // namespace bnvpl
