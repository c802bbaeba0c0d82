#include "transport/bsdf/model_report.h"

#include <algorithm>

#include "transport/bsdf.h"
#include "transport/bsdf/ggx/reflection.h"

namespace bnvpl {

namespace {

// The image of an expression that consists of the unmodified image; otherwise kNone.
uint32_t plainImage(const Scene& scene, uint32_t expression) {
  if (expression == kNone) return kNone;
  const TextureExpression& e = scene.expressions[expression];
  const bool plain = e.kind == TextureExpression::Kind::Image && e.channel == Channel::Rgb &&
                     !e.invert && e.value == Vec3(1) && e.wrapU == Wrap::Repeat &&
                     e.wrapV == Wrap::Repeat && e.uv == UvTransform();
  return plain ? e.image : kNone;
}

Vec3 atNormalIncidence(const ConductorFresnel& f) {
  if (f.byReflectance) return f.reflectance.value;
  const Vec3 k2 = f.k.value * f.k.value, less = f.eta.value - Vec3(1), more = f.eta.value + Vec3(1);
  const Vec3 mirrored = less * less + k2, all = more * more + k2;
  return {mirrored.x / all.x, mirrored.y / all.y, mirrored.z / all.z};
}

}  // namespace

void ModelReport::add(const std::string& name, const Roughness& r) {
  static constexpr const char* kAlpha[] = {"roughness", "roughness^2", "sqrt(roughness)"};
  add(name, r.along);
  if (r.across.value != r.along.value || r.across.texture != r.along.texture)
    add(name + "_across", r.across);
  add("alpha", std::string(kAlpha[static_cast<size_t>(r.alpha)]));
}

void ModelReport::add(const ConductorFresnel& f) {
  if (f.byReflectance) return add("reflectance", f.reflectance);
  add("eta", f.eta);
  add("k", f.k);
}

ModelReport describeModel(const Scene& scene, const MaterialModel& model) {
  return std::visit([&](const auto& m) { return describe(scene, m); }, model);
}

MtlModel modelToMtl(const Scene& scene, const MaterialModel& model) {
  return std::visit([&](const auto& m) { return toMtl(scene, m); }, model);
}

MtlModel diffuseMtl(const Scene& scene, const Colour& c) {
  MtlModel mtl;
  mtl.phong.diffuse = min(c.value, Vec3(1));
  mtl.phong.diffuseMap = plainImage(scene, c.texture);
  return mtl;
}

MtlModel metalMtl(const ConductorFresnel& fresnel, const Roughness& roughness) {
  constexpr float kSmooth = 0.03f, kMaxExponent = 9999.0f;
  const auto alphaAlong = [&](const Scalar& r) {
    return alphaOf(roughness.alpha, std::clamp(r.value, 0.0f, 1.0f));
  };
  const float alpha = std::sqrt(alphaAlong(roughness.along) * alphaAlong(roughness.across));
  MtlModel mtl;
  const Vec3 albedo = min(atNormalIncidence(fresnel), Vec3(1));
  if (alpha < kSmooth) {
    mtl.phong.mirror = albedo;
  } else {
    mtl.phong.glossy = albedo;
    mtl.phong.exponent = std::min(kMaxExponent, std::max(0.0f, 2.0f / (alpha * alpha) - 2.0f));
  }
  return mtl;
}

MtlModel glassMtl(float ior, Vec3 transmission) {
  MtlModel mtl;
  mtl.phong.glass = true;
  mtl.phong.ior = std::clamp(ior, 1.0f, 100.0f);
  mtl.phong.transmission = min(transmission, Vec3(1));
  mtl.phong.mirror = Vec3(1);
  return mtl;
}

}  // namespace bnvpl
