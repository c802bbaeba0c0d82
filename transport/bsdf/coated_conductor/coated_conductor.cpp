#include "transport/bsdf/coated_conductor/coated_conductor.h"

#include "transport/bsdf.h"
#include "transport/bsdf/conductor/conductor.h"
#include "transport/bsdf/model_report.h"

namespace bnvpl {

// Fresnel reflectance of the metal at the refracted angle, times the coat's transmittances at wo
// and wi, summed over all reflections between coat and metal. Each crosses the coat twice.
Vec3 CoatedMetal::through(Vec3 wo, Vec3 wi, float cosFacet) const {
  const float o = coat(wo.z), i = coat(wi.z), back = std::min(o, i);
  const float kept = absorption.across(wo.z) * absorption.across(wi.z);
  Vec3 f = metal.fresnel.at(refractedCosine(std::min(1.0f, cosFacet), absorption.ior)) * kept;
  for (size_t c = 0; c < 3; ++c) {
    f[c] = back < 1.0f ? f[c] * (1.0f - o) * (1.0f - i) / (1.0f - f[c] * back) : 0.0f;
  }
  return f;
}

Vec3 CoatedMetal::value(Vec3 wo, Vec3 wi, TransportMode) const {
  if (smooth() || wi.z <= 0.0f) return {};
  const Vec3 h = normalize(wo + wi);
  return through(wo, wi, dot(wo, h)) * metal.ggx.reflected(wo, wi, h);
}

bool CoatedMetal::sample(Vec3 wo, float pick, Point2 at, LobeSample& out) const {
  if (!metal.sample(wo, pick, at, out)) return false;
  if (smooth()) out.weight = through(wo, out.wi, wo.z);
  return true;
}

// Albedo of mirror reflection, which approximates that of rough metal; the latter is reduced by the
// energy that facets lose.
Vec3 CoatedMetal::albedo(Vec3 wo) const { return through(wo, wo, wo.z) * stays(wo); }

float CoatedMetal::stays(Vec3 wo) const {
  return smooth() ? 1.0f : 1.0f - ggxLoss(wo.z, metal.ggx.meanAlpha());
}

Vec3 CoatedMetal::exactAlbedo(Vec3 wo) const {
  return stays(wo) * metal.ggx.meanOverReflected(
                         wo, [&](Vec3 wi, Vec3 h) { return through(wo, wi, dot(wo, h)); });
}

void addLobes(const CoatedConductorModel& model, const MaterialInputs& inputs, Vec3 weight,
              Bsdf& out) {
  const Ggx coat = ggxOf(model.coatRoughness, inputs);
  const float ior = std::min(kMaxAlbedoIor, inputs.coatIor(model.coatIor));
  const GgxReflection metal{ggxOf(model.roughness, inputs),
                            metalFresnel(model.fresnel, ior, inputs)};
  out.add(weight, GgxReflection{coat, {FacetFresnel::Kind::Dielectric, Vec3(ior), {}}});
  out.add(weight, CoatedMetal{metal,
                              {inputs.thickness(model.coatThickness), ior},
                              coat.smooth() ? 0.0f : coat.meanAlpha()});
}

ModelReport describe(const Scene&, const CoatedConductorModel& m) {
  ModelReport out{"coated conductor", {}};
  out.add(m.fresnel);
  out.add("roughness", m.roughness);
  out.add("coat_ior", m.coatIor);
  out.add("coat_roughness", m.coatRoughness);
  if (m.coatThickness.value > 0) out.add("coat_thickness", m.coatThickness);
  return out;
}

MtlModel toMtl(const Scene&, const CoatedConductorModel& m) {
  return metalMtl(m.fresnel, m.roughness);
}

}  // namespace bnvpl
