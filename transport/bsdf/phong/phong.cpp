#include "transport/bsdf/phong/phong.h"

#include "transport/bsdf.h"
#include "transport/bsdf/model_report.h"

namespace bnvpl {

bool mayBeSpecular(const PhongModel& m) {
  return m.glass || !isBlack(m.mirror) ||
         (!isBlack(m.glossy) && m.exponent > kNearSpecularExponent);
}

std::optional<bool> roughEverywhere(const PhongModel& m) {
  if (mayBeSpecular(m) || m.diffuseMap != kNone || m.glossyMap != kNone) return {};
  return !isBlack(m.diffuse + m.glossy);
}

void addLobes(const PhongModel& m, const MaterialInputs& inputs, Vec3 weight, Bsdf& out) {
  if (m.glass) {
    DielectricModel glass;
    glass.ior = m.ior, glass.reflection = m.mirror, glass.transmission = m.transmission;
    return addLobes(glass, inputs, weight, out);
  }
  Vec3 diffuse = inputs.raw(m.diffuse, m.diffuseMap), glossy = inputs.raw(m.glossy, m.glossyMap),
       mirror = inputs.raw(m.mirror, m.glossyMap);
  const float sum = maxComponent(diffuse + glossy + mirror);
  if (sum > 1.0f) weight *= 1.0f / sum;
  out.add(weight, LambertLobe{diffuse});
  if (!isBlack(glossy)) out.add(weight, PhongLobe{glossy, m.exponent});
  if (isBlack(mirror)) return;
  out.add(weight, GgxReflection{{0.0f, 0.0f}, {FacetFresnel::Kind::Schlick, mirror, mirror}});
}

ModelReport describe(const Scene&, const PhongModel& m) {
  ModelReport out;
  out.model = m.glass ? "glass" : "phong";
  if (m.glass) {
    out.add("ior", Scalar(m.ior));
    out.add("transmission", Colour(m.transmission));
    out.add("mirror", Colour(m.mirror));
    return out;
  }
  out.add("diffuse", ModelReport::Image{m.diffuse, m.diffuseMap});
  if (!isBlack(m.glossy) || m.glossyMap != kNone) {
    out.add("glossy", ModelReport::Image{m.glossy, m.glossyMap});
    out.add("exponent", Scalar(m.exponent));
  }
  if (!isBlack(m.mirror)) out.add("mirror", Colour(m.mirror));
  return out;
}

MtlModel toMtl(const Scene&, const PhongModel& m) { return {m, {}, true}; }

}  // namespace bnvpl
