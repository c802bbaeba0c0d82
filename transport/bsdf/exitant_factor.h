// Dependence of the rough group's value on wo, where it is a product of a factor of wi and one of
// wo. Light estimated for one viewing direction can then be reused for others.
#pragma once

#include "transport/bsdf/coated_diffuse/coated_diffuse.h"
#include "transport/bsdf/lobe_frame.h"

namespace bnvpl {

struct ExitantFactor {
  Vec3 ng, ns;
  CoatAbsorption coat{0.0f, 0.0f};  // over a diffuse base; ior 0: there is none
  float alpha = 0.0f;               // the coat's
  bool unbent = false;              // whether the factor is unknown where wo bends the normal

  // The factor of wo, unit. 0 where it is unknown: the coat transmits next to nothing, or wo bends
  // the normal.
  float towards(Vec3 wo) const {
    constexpr float kMinFactor = 1e-3f;
    if (coat.ior == 0.0f) return !unbent || keepsNormal(ng, ns, wo) ? 1.0f : 0.0f;
    if (!keepsNormal(ng, ns, wo)) return 0.0f;
    const float out = CoatedBase{{}, coat, alpha}.through(dot(ns, wo));
    return out > kMinFactor ? out : 0.0f;
  }
};

// The part of the rough group's value that is such a product, where the whole is not.
struct DiffusePart {
  ExitantFactor leaving;
  Vec3 value;  // 1/sr, without the cosine with ns, for light from ns's side
};

}  // namespace bnvpl
