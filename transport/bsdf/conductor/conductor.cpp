#include "transport/bsdf/conductor/conductor.h"

#include "transport/bsdf.h"
#include "transport/bsdf/model_report.h"

namespace bnvpl {

namespace {

constexpr float kMaxReflectance = 0.9999f;  // 1 would need an infinite k
float kOfReflectance(float r) {
  r = std::clamp(r, 0.0f, kMaxReflectance);
  return 2.0f * std::sqrt(r) / std::sqrt(1.0f - r);
}

}  // namespace

FacetFresnel metalFresnel(const ConductorFresnel& fresnel, float outside,
                          const MaterialInputs& inputs) {
  FacetFresnel out{FacetFresnel::Kind::Conductor, {}, {}};
  if (fresnel.byReflectance) {
    const Vec3 r = inputs.raw(fresnel.reflectance);
    // The metal has this reflectance in air, also where it lies below a coat, as in pbrt.
    out.first = Vec3(1.0f / outside);
    out.second =
        Vec3{kOfReflectance(r.x), kOfReflectance(r.y), kOfReflectance(r.z)} * (1.0f / outside);
  } else {
    const auto index = [&](const Colour& c) {
      return min(max(inputs.raw(c), Vec3()), Vec3(100)) * (1.0f / outside);
    };
    out.first = index(fresnel.eta);
    out.second = index(fresnel.k);
  }
  return out;
}

MultipleScattering multipleScattering(const FacetFresnel& metal, const Ggx& ggx) {
  const float alpha = ggx.meanAlpha(), lost = ggxMeanLoss(alpha);
  if (!(lost > 1e-6f)) return {Vec3(), alpha, ggx.rough()};
  const Vec3 f = schlickOf(metal.first, metal.second).mean();
  Vec3 again;  // Fms of theory.md, eq. 3
  for (size_t c = 0; c < 3; ++c) again[c] = f[c] * f[c] * (1.0f - lost) / (1.0f - f[c] * lost);
  return {max(again, Vec3()) * (1.0f / (kPi * lost)), alpha, ggx.rough()};
}

void addLobes(const ConductorModel& model, const MaterialInputs& inputs, Vec3 weight, Bsdf& out) {
  const GgxReflection metal{ggxOf(model.roughness, inputs),
                            metalFresnel(model.fresnel, 1.0f, inputs)};
  out.add(weight, metal);
  if (model.multipleScattering && !metal.smooth())
    out.add(weight, multipleScattering(metal.fresnel, metal.ggx));
}

ModelReport describe(const Scene&, const ConductorModel& m) {
  ModelReport out{"conductor", {}};
  out.add(m.fresnel);
  out.add("roughness", m.roughness);
  out.add("multiple_scattering", m.multipleScattering);
  return out;
}

MtlModel toMtl(const Scene&, const ConductorModel& m) { return metalMtl(m.fresnel, m.roughness); }

}  // namespace bnvpl
