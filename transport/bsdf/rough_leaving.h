// Where the rough group's value is a product, of what goes in by wi and what comes out by wo: how
// it depends on wo. So light that was found out for one eye is known for others.
#pragma once

#include "transport/bsdf/coated_diffuse/coated_diffuse.h"
#include "transport/bsdf/lobe_frame.h"

namespace bnvpl {

struct RoughLeaving {
  Vec3 ng, ns;
  float ior = 0.0f, alpha = 0.0f;  // of a coat over a matt base; ior 0: matt without one
  bool unbent = false;             // not known where wo bends the normal

  // A factor of the radiance towards wo, unit; 0: not known, as the coat leaves next to nothing or
  // its normal bends.
  float towards(Vec3 wo) const {
    constexpr float kMin = 1e-3f;
    if (ior == 0.0f) return !unbent || keepsNormal(ng, ns, wo) ? 1.0f : 0.0f;
    if (!keepsNormal(ng, ns, wo)) return 0.0f;
    const float out = CoatedBase{{}, ior, alpha}.through(dot(ns, wo));
    return out > kMin ? out : 0.0f;
  }
};

// A part of the rough group's value that is such a product, where the whole is not.
struct DiffusePart {
  RoughLeaving leaving;
  Vec3 value;  // 1/sr, for light from the shading normal's side: times the cosine with it
};

}  // namespace bnvpl
