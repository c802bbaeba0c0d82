// Metals: GGX with complex Fresnel reflectance, and multiple scattering between facets.
#pragma once

#include "transport/bsdf/ggx/reflection.h"

namespace bnvpl {

// Light that facets scatter more than once, as a nearly diffuse lobe (Kulla & Conty 2017).
struct MultipleScattering {
  Vec3 scale;  // factor of the losses at wo and wi, 1/sr: theory.md, eq. 2
  float alpha = 0.0f;
  bool isRough = false;

  bool smooth() const { return false; }
  LobeGroup group() const { return isRough ? LobeGroup::Rough : LobeGroup::Specular; }
  Vec3 value(Vec3 wo, Vec3 wi, TransportMode) const {
    return wi.z > 0.0f ? scale * (ggxLoss(wo.z, alpha) * ggxLoss(wi.z, alpha)) : Vec3{};
  }
  float pdf(Vec3, Vec3 wi) const { return pdfCosineHemisphere(wi.z); }
  bool sample(Vec3, float, Point2 at, LobeSample& out) const {
    out.wi = sampleCosineHemisphere(at.x, at.y);
    return out.wi.z > 0.0f;
  }
  Vec3 albedo(Vec3 wo) const { return scale * (ggxLoss(wo.z, alpha) * kPi * ggxMeanLoss(alpha)); }
  Vec3 bound(Vec3 wo, float maxCosine, float) const {
    return scale * (ggxLoss(wo.z, alpha) * ggxLargestLoss(alpha) * std::max(0.0f, maxCosine));
  }
};
MultipleScattering multipleScattering(const FacetFresnel& metal, const Ggx& ggx);

// Reflectance of the metal against a medium of index `outside`.
FacetFresnel metalFresnel(const ConductorFresnel& fresnel, float outside,
                          const MaterialInputs& inputs);

void addLobes(const ConductorModel& model, const MaterialInputs& inputs, Vec3 weight, Bsdf& out);
ModelReport describe(const Scene& scene, const ConductorModel& model);
MtlModel toMtl(const Scene& scene, const ConductorModel& model);

}  // namespace bnvpl
