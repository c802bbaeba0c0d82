// glTF 2.0's material, appendix B, with the extensions ior, specular, clearcoat and transmission.
#pragma once

#include "transport/bsdf/ggx/reflection.h"

namespace bnvpl {

// The base below the specular layer of a non-metal: Lambertian, or, for the transmission of a thin
// wall, a GGX lobe mirrored to the other side. It is scaled by 1 - F(wo.h), glTF's fresnel_mix, and
// by less where that would gain energy (theory.md, eq. 3).
struct LayeredBase {
  Vec3 colour;
  float f0 = 0.04f, f90 = 1.0f;  // largest channels of the layer's reflectances
  float alpha = 0.0f;            // the layer's roughness
  bool transmitted = false;
  AtCosine keptAtWo = {};

  bool smooth() const { return transmitted && alpha < kSmoothAlpha; }
  LobeGroup group() const { return transmitted ? LobeGroup::Specular : LobeGroup::Rough; }
  Vec3 value(Vec3 wo, Vec3 wi, TransportMode) const;
  float pdf(Vec3 wo, Vec3 wi) const;
  bool sample(Vec3 wo, float pick, Point2 at, LobeSample& out) const;
  Vec3 albedo(Vec3 wo) const;
  Vec3 bound(Vec3 wo, float maxCosine, float) const {
    return colour * (keptFrom(wo) * std::max(0.0f, maxCosine) / kPi);
  }
  void prepareFor(Vec3 wo) { keptAtWo = {wo.z, kept(wo.z)}; }

  float layer(float cosine) const;  // Fresnel reflectance of the layer's facets
  float kept(float cosine) const;   // k(w) of theory.md, eq. 3

 private:
  Ggx ggx() const { return {alpha, alpha}; }
  float keptFrom(Vec3 wo) const {
    return keptAtWo.orElse(wo.z, [this](float cosine) { return kept(cosine); });
  }
  float unlayered(float cosine) const;  // albedo of a white base under fresnel_mix
};

inline bool isGlass(const MetallicRoughnessModel& model, const Scene&) {
  return model.transmission.value > 0.0f;
}

void addLobes(const MetallicRoughnessModel& model, const MaterialInputs& inputs, Vec3 weight,
              Bsdf& out);
ModelReport describe(const Scene& scene, const MetallicRoughnessModel& model);
MtlModel toMtl(const Scene& scene, const MetallicRoughnessModel& model);

}  // namespace bnvpl
