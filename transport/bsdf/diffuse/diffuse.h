// Lambert's law, above or below the surface.
#pragma once

#include "transport/bsdf/lobe.h"

namespace bnvpl {

// Cosines refer to the unbent shading normal (Bsdf), so that the value does not depend on wo.
struct LambertLobe {
  Vec3 colour;
  bool transmitted = false;

  bool smooth() const { return false; }
  LobeGroup group() const { return transmitted ? LobeGroup::Specular : LobeGroup::Rough; }
  bool onSide(Vec3 wi) const { return transmitted ? wi.z < 0.0f : wi.z > 0.0f; }
  Vec3 value(Vec3, Vec3 wi, TransportMode) const {
    return onSide(wi) ? colour * (1.0f / kPi) : Vec3{};
  }
  float pdf(Vec3, Vec3 wi) const {
    return onSide(wi) ? pdfCosineHemisphere(std::fabs(wi.z)) : 0.0f;
  }
  bool sample(Vec3, float, Point2 at, LobeSample& out) const {
    out.wi = sampleCosineHemisphere(at.x, at.y);
    if (transmitted) out.wi.z = -out.wi.z;
    return out.wi.z != 0.0f;
  }
  Vec3 albedo(Vec3) const { return colour; }
  Vec3 bound(Vec3, float maxCosine, float) const {
    return colour * (std::max(0.0f, maxCosine) / kPi);
  }
};

inline std::optional<bool> roughEverywhere(const DiffuseModel& m) {
  if (m.reflectance.texture != kNone) return {};
  return maxComponent(m.reflectance.value) > 0.0f;
}
inline bool mayBeSpecular(const DiffuseModel&) { return false; }

void addLobes(const DiffuseModel& model, const MaterialInputs& inputs, Vec3 weight, Bsdf& out);
ModelReport describe(const Scene& scene, const DiffuseModel& model);
MtlModel toMtl(const Scene& scene, const DiffuseModel& model);

}  // namespace bnvpl
