// GGX interface between the outside, on the side of the winding, and the inside; pbrt's
// `dielectric` and `thindielectric`.
#pragma once

#include "scene/models/parameters.h"

namespace bnvpl {

struct DielectricModel {
  static constexpr const char* kName = "dielectric";
  static constexpr uint32_t kHashId = 4;
  static constexpr uint32_t kLobes = 1;
  Scalar ior{1.5f};  // index of the inside relative to the outside
  Roughness roughness{Scalar(0.0f)};
  Colour reflection{Vec3(1)}, transmission{Vec3(1)};  // tints; the physical value is 1
  // A sheet with parallel faces, always smooth. Light passes straight through, and the series of
  // internal reflections is summed.
  bool thin = false;
};

template <Like<DielectricModel> M, typename Fn>
void forEachField(M& m, const Fn& fn) {
  fn("ior", m.ior);
  forEachField(m.roughness, kRoughnessNames, fn);
  fn("reflection", m.reflection);
  fn("transmission", m.transmission);
  fn("thin", m.thin);
}

}  // namespace bnvpl
