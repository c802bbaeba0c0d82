#include "transport/bsdf/dielectric/dielectric.h"

#include "transport/bsdf.h"
#include "transport/bsdf/fresnel.h"
#include "transport/bsdf/ggx/reflection.h"
#include "transport/bsdf/model_report.h"

namespace bnvpl {

namespace {

// Below this difference of the indices the facet cannot be recovered from wo and wi, and the
// interface counts as smooth.
constexpr float kNoBend = 1e-3f;

Vec3 refracted(Vec3 wo, Vec3 h, float eta, float cosT) {
  return normalize(h * (dot(wo, h) / eta - cosT) - wo * (1.0f / eta));
}

// Normal, on z's side, of the facet that reflects or refracts wo to wi.
Vec3 facetBetween(Vec3 wo, Vec3 wi, float eta) {
  const Vec3 h = normalize(wi.z > 0.0f ? wo + wi : wo + wi * eta);
  return h.z < 0.0f ? -h : h;
}

}  // namespace

Vec3 DielectricLobe::value(Vec3 wo, Vec3 wi, TransportMode transport) const {
  if (smooth() || wi.z == 0.0f) return {};
  const Vec3 h = facetBetween(wo, wi, eta);
  const float o = dot(wo, h), i = dot(wi, h);
  if (o <= 0.0f || (wi.z > 0.0f) != (i > 0.0f)) return {};
  const float reflected = fresnelDielectric(std::min(1.0f, o), eta);
  if (wi.z > 0.0f) return reflection * (reflected * ggx.reflected(wo, wi, h));
  const float bend = o + eta * i;
  return transmission * ((1.0f - reflected) * ggx.density(h) * ggx.visible(wo, wi) * o * -i * eta *
                         eta / (wo.z * -wi.z * bend * bend) * radianceScale(transport));
}

float DielectricLobe::pdf(Vec3 wo, Vec3 wi) const {
  if (smooth() || wi.z == 0.0f) return 0.0f;
  const Vec3 h = facetBetween(wo, wi, eta);
  const float o = dot(wo, h), i = dot(wi, h);
  if (o <= 0.0f || (wi.z > 0.0f) != (i > 0.0f)) return 0.0f;
  const float reflected = fresnelDielectric(std::min(1.0f, o), eta);
  const float facets = ggx.visibleDensity(wo, h);
  if (wi.z > 0.0f) return reflected * facets / (4.0f * o);
  const float bend = o + eta * i;
  return (1.0f - reflected) * facets * eta * eta * -i / (bend * bend);
}

// The weight of a smooth lobe leaves out radianceScale(), which Bsdf applies.
bool DielectricLobe::sample(Vec3 wo, float pick, Point2 at, LobeSample& out) const {
  const Vec3 h = smooth() ? Vec3{0, 0, 1} : ggx.sampleVisible(wo, at);
  const float cosine = std::min(1.0f, dot(wo, h));
  if (!(cosine > 0.0f)) return false;
  float cosT = 0.0f;
  if (pick < fresnelDielectric(cosine, eta, cosT)) {
    out.wi = normalize(reflect(wo, h));
    out.weight = reflection;
    return out.wi.z > 0.0f;
  }
  out.wi = refracted(wo, h, eta, cosT);
  out.weight = transmission;
  return out.wi.z < 0.0f;
}

// R' = R + T^2 R / (1 - R^2) and T' = 1 - R', with R and T = 1 - R of one side (pbrt-v4,
// section 9.5.1).
bool ThinSheetLobe::sample(Vec3 wo, float pick, Point2, LobeSample& out) const {
  const float r = fresnelDielectric(std::min(1.0f, wo.z), ior);
  const float all = r < 1.0f ? 2.0f * r / (1.0f + r) : 1.0f;
  const bool reflects = pick < all;
  out.wi = reflects ? mirrored(wo) : -wo;
  out.weight = reflects ? reflection : transmission;
  return true;
}

void addLobes(const DielectricModel& model, const MaterialInputs& inputs, Vec3 weight, Bsdf& out) {
  const float ior = inputs.ior(model.ior);
  const Vec3 reflection = inputs.share(model.reflection),
             transmission = inputs.share(model.transmission);
  if (model.thin) {
    out.add(weight, ThinSheetLobe{ior, reflection, transmission});
    return;
  }
  DielectricLobe lobe{ggxOf(model.roughness, inputs), inputs.front() ? ior : 1.0f / ior, reflection,
                      transmission};
  if (std::fabs(ior - 1.0f) < kNoBend) lobe.ggx = {0.0f, 0.0f};
  out.add(weight, lobe);
}

ModelReport describe(const Scene&, const DielectricModel& m) {
  ModelReport out{m.thin ? "thin dielectric" : "dielectric", {{"ior", m.ior}}};
  out.add("roughness", m.roughness);
  out.add("reflection", m.reflection);
  out.add("transmission", m.transmission);
  return out;
}

MtlModel toMtl(const Scene&, const DielectricModel& m) {
  return glassMtl(m.ior.value, m.transmission.value);
}

}  // namespace bnvpl
