// Where the rough group's value is a product, of what goes in by wi and what comes out by wo: how
// it depends on wo. So light that was found out for one eye is known for others.
#pragma once

#include "transport/bsdf/coated_diffuse/coated_diffuse.h"
#include "transport/bsdf/lobe_frame.h"

namespace bnvpl {

struct RoughLeaving {
  Vec3 ng, ns;
  float ior = 0.0f, alpha = 0.0f;  // of a coat over a matt base; ior 0: matt without one

  // A factor of the radiance towards wo, unit; 0: not known, as the coat leaves next to nothing or
  // its normal bends.
  float towards(Vec3 wo) const {
    constexpr float kLeast = 1e-3f;
    if (ior == 0.0f) return 1.0f;
    if (!keepsNormal(ng, ns, wo)) return 0.0f;
    const float out = CoatedBase{{}, ior, alpha}.through(dot(ns, wo));
    return out > kLeast ? out : 0.0f;
  }
};

}  // namespace bnvpl
