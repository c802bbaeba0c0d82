#include "transport/bsdf/coated_diffuse/coated_diffuse.h"

#include "transport/bsdf.h"
#include "transport/bsdf/model_report.h"

namespace bnvpl {

namespace {

// Cosine-weighted mean of the light that crosses the coat, of which a coat that absorbs nothing
// lets `in` through. A thin coat takes the same share from all directions, within 0.1 %.
float meanThrough(const CoatedBase& base, float in) {
  constexpr float kThin = 0.1f;
  if (base.coat.thickness < kThin) return in * base.coat.meanAcross();
  constexpr int kSteps = 16;
  float sum = 0.0f;
  for (int i = 0; i < kSteps; ++i)
    sum += base.through(std::sqrt((static_cast<float>(i) + 0.5f) / kSteps));
  return sum / kSteps;
}

}  // namespace

void addLobes(const CoatedDiffuseModel& model, const MaterialInputs& inputs, Vec3 weight,
              Bsdf& out) {
  const Ggx ggx = ggxOf(model.roughness, inputs);
  const float ior = std::min(kMaxAlbedoIor, inputs.coatIor(model.ior));
  const float alpha = ggx.smooth() ? 0.0f : ggx.meanAlpha();
  const Vec3 base = inputs.share(model.reflectance);
  const float in = 1.0f - dielectricMeanAlbedo(alpha, ior);  // transmitted share of diffuse light
  const CoatAbsorption coat{inputs.thickness(model.thickness), ior};
  // Fi: reflected share of diffuse light from below
  const float trapped = (1.0f - in / (ior * ior)) * coat.meanBack();
  Vec3 scale;
  for (size_t c = 0; c < 3; ++c)
    scale[c] = base[c] / (kPi * ior * ior * (1.0f - base[c] * trapped));
  out.add(weight, GgxReflection{ggx, {FacetFresnel::Kind::Dielectric, Vec3(ior), {}}});
  CoatedBase lower{scale, coat, alpha};
  lower.meanThrough = meanThrough(lower, in);
  out.add(weight, lower);
}

ModelReport describe(const Scene&, const CoatedDiffuseModel& m) {
  ModelReport out{"coated diffuse", {{"reflectance", m.reflectance}, {"ior", m.ior}}};
  out.add("roughness", m.roughness);
  if (m.thickness.value > 0) out.add("thickness", m.thickness);
  return out;
}

MtlModel toMtl(const Scene& scene, const CoatedDiffuseModel& m) {
  return diffuseMtl(scene, m.reflectance);
}

}  // namespace bnvpl
