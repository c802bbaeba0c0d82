// GGX metal below a dielectric coat; pbrt's `coatedconductor`.
#pragma once

#include "scene/models/parameters.h"

namespace bnvpl {

struct CoatedConductorModel {
  static constexpr const char* kName = "coated_conductor";
  static constexpr uint32_t kHashId = 6;
  static constexpr uint32_t kLobes = 2;
  ConductorFresnel fresnel;  // relative to vacuum; the model divides by the coat's index
  Roughness roughness{Scalar(0.0f)};
  Scalar coatIor{1.5f};
  Roughness coatRoughness{Scalar(0.0f)};
  Scalar coatThickness{0.0f};  // in mean free paths: the coat absorbs, as in pbrt
};

template <Like<CoatedConductorModel> M, typename Fn>
void forEachField(M& m, const Fn& fn) {
  forEachField(m.fresnel, fn);
  forEachField(m.roughness, kRoughnessNames, fn);
  fn("coat_ior", m.coatIor);
  forEachField(m.coatRoughness,
               {"coat_roughness_along", "coat_roughness_across", "coat_roughness_to_alpha"}, fn);
  fn("coat_thickness", m.coatThickness);
}

}  // namespace bnvpl
