// GGX metal; pbrt's `conductor`.
#pragma once

#include "scene/models/parameters.h"

namespace bnvpl {

struct ConductorModel {
  static constexpr const char* kName = "conductor";
  static constexpr uint32_t kHashId = 3;
  static constexpr uint32_t kLobes = 2;
  ConductorFresnel fresnel;
  Roughness roughness{Scalar(0.1f)};
  // Adds the energy that scatters more than once between microfacets (Kulla & Conty 2017). pbrt and
  // Cycles' plain GGX omit it.
  bool multipleScattering = true;
};

template <Like<ConductorModel> M, typename Fn>
void forEachField(M& m, const Fn& fn) {
  forEachField(m.fresnel, fn);
  forEachField(m.roughness, kRoughnessNames, fn);
  fn("multiple_scattering", m.multipleScattering);
}

}  // namespace bnvpl
