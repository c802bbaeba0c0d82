#include "transport/bsdf/coated_diffuse/coated_diffuse.h"

#include "transport/bsdf.h"
#include "transport/bsdf/model_report.h"

namespace bnvpl {

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
  out.add(weight, CoatedBase{scale, coat, alpha, in * coat.meanAcross()});
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
