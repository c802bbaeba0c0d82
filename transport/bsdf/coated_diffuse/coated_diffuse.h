// Plastic, varnish, glazed tiles: Lambert below a dielectric coat.
#pragma once

#include "transport/bsdf/coat_absorption.h"
#include "transport/bsdf/ggx/reflection.h"

namespace bnvpl {

// Light that enters through the coat and leaves through it again, after the base has scattered it
// any number of times.
struct CoatedBase {
  Vec3 scale;  // factor of the transmittances at wo and wi, 1/sr: theory.md, eq. 2
  CoatAbsorption coat;
  float alpha = 0.0f;
  float meanThrough = 1.0f;  // that of diffuse light
  AtCosine throughAtWo = {};

  bool smooth() const { return false; }
  LobeGroup group() const { return LobeGroup::Rough; }
  void prepareFor(Vec3 wo) { throughAtWo = {wo.z, through(wo.z)}; }
  float through(float cosine) const {
    return (1.0f - dielectricAlbedo(cosine, alpha, coat.ior)) * coat.across(cosine);
  }
  Vec3 value(Vec3 wo, Vec3 wi, TransportMode) const {
    return wi.z > 0.0f ? scale * (throughFrom(wo) * through(wi.z)) : Vec3{};
  }
  float pdf(Vec3, Vec3 wi) const { return pdfCosineHemisphere(wi.z); }
  bool sample(Vec3, float, Point2 at, LobeSample& out) const {
    out.wi = sampleCosineHemisphere(at.x, at.y);
    return out.wi.z > 0.0f;
  }
  Vec3 albedo(Vec3 wo) const { return scale * (through(wo.z) * kPi * meanThrough); }
  Vec3 bound(Vec3 wo, float maxCosine, float) const {
    return scale * (throughFrom(wo) * std::max(0.0f, maxCosine));
  }

 private:
  float throughFrom(Vec3 wo) const {
    return throughAtWo.orElse(wo.z, [this](float cosine) { return through(cosine); });
  }
};

void addLobes(const CoatedDiffuseModel& model, const MaterialInputs& inputs, Vec3 weight,
              Bsdf& out);
ModelReport describe(const Scene& scene, const CoatedDiffuseModel& model);
MtlModel toMtl(const Scene& scene, const CoatedDiffuseModel& model);

}  // namespace bnvpl
