#include "transport/bsdf/metallic_roughness/metallic_roughness.h"

#include "transport/bsdf.h"
#include "transport/bsdf/fresnel.h"
#include "transport/bsdf/metallic_roughness/layered_albedo.h"
#include "transport/bsdf/model_report.h"

namespace bnvpl {

namespace {

constexpr float kCoatF0 = 0.04f;  // reflectance of a clearcoat of index 1.5 at normal incidence

Vec3 below(Vec3 w) { return {w.x, w.y, -w.z}; }
float mixed(float a, float b, float share) { return a + (b - a) * share; }
Vec3 mixed(Vec3 a, Vec3 b, float share) { return a + (b - a) * share; }

}  // namespace

float LayeredBase::layer(float cosine) const { return f0 + (f90 - f0) * schlickWeight(cosine); }

float LayeredBase::unlayered(float cosine) const {
  if (!transmitted) return 1.0f - f0 - (f90 - f0) * schlickOverHemisphere(cosine);
  return ggxAlbedo(1.0f - f0, 1.0f - f90, cosine, alpha);
}

float LayeredBase::kept(float cosine) const {
  const float reflected = ggxAlbedo(f0, f90, cosine, alpha);
  const float base = unlayered(cosine);
  return base > 1.0f - reflected ? (1.0f - reflected) / base : 1.0f;
}

Vec3 LayeredBase::value(Vec3 wo, Vec3 wi, TransportMode) const {
  if (smooth() || (transmitted ? wi.z >= 0.0f : wi.z <= 0.0f)) return {};
  const Vec3 above = transmitted ? below(wi) : wi, h = normalize(wo + above);
  const float share = (1.0f - layer(dot(wo, h))) * std::min(keptFrom(wo), kept(above.z));
  return colour * (share * (transmitted ? ggx().reflected(wo, above, h) : 1.0f / kPi));
}

float LayeredBase::pdf(Vec3 wo, Vec3 wi) const {
  if (!transmitted) return pdfCosineHemisphere(wi.z);
  if (smooth() || wi.z >= 0.0f) return 0.0f;
  const Vec3 h = normalize(wo + below(wi));
  return ggx().visibleDensity(wo, h) / (4.0f * dot(wo, h));
}

bool LayeredBase::sample(Vec3 wo, float, Point2 at, LobeSample& out) const {
  if (!transmitted) {
    out.wi = sampleCosineHemisphere(at.x, at.y);
    return out.wi.z > 0.0f;
  }
  if (smooth()) {
    out.wi = -wo;
    out.weight = colour * ((1.0f - layer(wo.z)) * kept(wo.z));
    return true;
  }
  out.wi = below(normalize(reflect(wo, ggx().sampleVisible(wo, at))));
  return out.wi.z < 0.0f;
}

Vec3 LayeredBase::albedo(Vec3 wo) const {
  if (!transmitted) return colour * layeredAlbedo(wo.z, f0, f90, alpha);
  const float base = smooth() ? 1.0f - layer(wo.z) : unlayered(wo.z);
  return colour * (base * kept(wo.z));
}

void addLobes(const MetallicRoughnessModel& model, const MaterialInputs& inputs, Vec3 weight,
              Bsdf& out) {
  const Vec3 base = inputs.share(model.baseColour);
  const float metallic = inputs.share(model.metallic), specular = inputs.share(model.specular);
  const float ior = inputs.raw(model.ior) > 0.0f ? inputs.coatIor(model.ior) : 0.0f;
  const float normal = ior > 0.0f ? (ior - 1.0f) / (ior + 1.0f) : 1.0f;
  const Vec3 f0 =
      min(Vec3(1), max(Vec3(), inputs.raw(model.specularColour)) * (normal * normal)) * specular;
  uint32_t brushed = 0;  // index of the facets' frame
  Ggx ggx = ggxOf(Roughness(model.roughness, Roughness::Alpha::Square), inputs);
  if (const float anisotropy = inputs.share(model.anisotropy); anisotropy > 0.0f && !ggx.smooth()) {
    const float aspect = std::sqrt(1.0f - 0.9f * anisotropy);
    ggx = {std::min(1.0f, ggx.alongX / aspect), std::max(kSmoothAlpha, ggx.alongY * aspect)};
    const float turns = inputs.raw(model.anisotropyTurns);
    const SurfacePoint& p = inputs.point();
    if (std::isfinite(turns)) brushed = out.frame(p.ns, p.front ? turns : -turns);
  }

  const float clearcoat = inputs.share(model.clearcoat);
  const Ggx coat = ggxOf(Roughness(model.clearcoatRoughness, Roughness::Alpha::Square), inputs);
  const Vec3 coatNormal = inputs.point().coat;
  const uint32_t coatFrame = clearcoat > 0.0f && !isBlack(coatNormal) ? out.frame(coatNormal) : 0;
  const CoatAbove above{clearcoat, coat.smooth() ? 0.0f : coat.meanAlpha(), coatFrame};
  // Metal and non-metal have the same facets, so one lobe with mixed reflectances represents both.
  out.add(weight,
          GgxReflection{ggx,
                        {FacetFresnel::Kind::Schlick, mixed(f0, base, metallic),
                         Vec3(mixed(specular, 1.0f, metallic))}},
          above, brushed);
  const float transmission = inputs.share(model.transmission);
  const float alpha = ggx.smooth() ? 0.0f : ggx.meanAlpha();
  LayeredBase lower{base * ((1.0f - metallic) * (1.0f - transmission)), maxComponent(f0), specular,
                    alpha, false};
  out.add(weight, lower, above);
  lower.colour = base * ((1.0f - metallic) * transmission);
  lower.transmitted = true;
  out.add(weight, lower, above);
  out.add(weight * clearcoat,
          GgxReflection{coat, {FacetFresnel::Kind::Schlick, Vec3(kCoatF0), Vec3(1)}}, {},
          coatFrame);
}

ModelReport describe(const Scene&, const MetallicRoughnessModel& m) {
  ModelReport out{
      "metallic-roughness",
      {{"base_colour", m.baseColour}, {"metallic", m.metallic}, {"roughness", m.roughness}}};
  if (m.anisotropy.value > 0) out.add("anisotropy", m.anisotropy);
  if (m.anisotropy.value > 0 && m.anisotropyTurns.value != 0)
    out.add("anisotropy_turns", m.anisotropyTurns);
  out.add("ior", m.ior);
  if (m.specular.value != 1 || m.specular.texture != kNone) out.add("specular", m.specular);
  if (m.specularColour.value != Vec3(1) || m.specularColour.texture != kNone)
    out.add("specular_colour", m.specularColour);
  if (m.clearcoat.value > 0) {
    out.add("clearcoat", m.clearcoat);
    out.add("clearcoat_roughness", m.clearcoatRoughness);
  }
  if (m.transmission.value > 0) out.add("transmission", m.transmission);
  return out;
}

MtlModel toMtl(const Scene& scene, const MetallicRoughnessModel& m) {
  if (m.transmission.value > 0.5f) return glassMtl(m.ior.value, m.baseColour.value);
  MtlModel mtl = diffuseMtl(scene, m.baseColour);
  const float normal = (m.ior.value - 1.0f) / (m.ior.value + 1.0f);
  mtl.facets = m;
  mtl.facets->specularColour.value = m.specularColour.value * (normal * normal * m.specular.value);
  return mtl;
}

}  // namespace bnvpl
