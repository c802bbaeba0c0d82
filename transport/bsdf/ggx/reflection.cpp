#include "transport/bsdf/ggx/reflection.h"

#include "transport/bsdf/fresnel.h"

namespace bnvpl {

float alphaOf(Roughness::Alpha mapping, float roughness) {
  switch (mapping) {
    case Roughness::Alpha::Same:
      return roughness;
    case Roughness::Alpha::Square:
      return roughness * roughness;
    case Roughness::Alpha::Root:
      return std::sqrt(roughness);
  }
  return roughness;
}

Ggx ggxOf(const Roughness& roughness, const MaterialInputs& inputs) {
  const auto alpha = [&](const Scalar& s) { return alphaOf(roughness.alpha, inputs.share(s)); };
  const Ggx ggx{alpha(roughness.along), alpha(roughness.across)};
  if (ggx.smooth()) return ggx;
  return {std::max(kSmoothAlpha, ggx.alongX), std::max(kSmoothAlpha, ggx.alongY)};
}

Vec3 FacetFresnel::at(float cosine) const {
  const float c = std::clamp(cosine, 0.0f, 1.0f);
  switch (kind) {
    case Kind::Schlick:
      return SchlickFresnel{first, second, {}}.at(c);
    case Kind::Conductor:
      return fresnelConductor(c, first, second);
    case Kind::Dielectric:
      return Vec3(fresnelDielectric(c, first.x));
  }
  return {};
}

Vec3 FacetFresnel::most(Vec3 wo) const {
  const float sine = std::sqrt(std::max(0.0f, 1.0f - wo.z * wo.z));
  const float least = std::sqrt(0.5f * std::max(0.0f, 1.0f - sine));
  return max(at(1.0f), at(0.999f * least)) * 1.0001f;
}

Vec3 FacetFresnel::albedo(float cosine, float alpha) const {
  switch (kind) {
    case Kind::Schlick:
      return ggxAlbedo({first, second, {}}, cosine, alpha);
    case Kind::Conductor:
      return ggxAlbedo(schlickOf(first, second), cosine, alpha);
    case Kind::Dielectric:
      return Vec3(dielectricAlbedo(cosine, alpha, first.x));
  }
  return {};
}

// The tables hold isotropic facets. The albedo of anisotropic ones depends on the azimuth, too, and
// is a sum over stratified visible normals.
Vec3 GgxReflection::albedo(Vec3 wo) const {
  if (smooth()) return fresnel.at(wo.z);
  if (ggx.alongX == ggx.alongY) return fresnel.albedo(wo.z, ggx.alongX);
  constexpr int kSide = 8;
  Vec3 sum;
  for (int i = 0; i < kSide * kSide; ++i) {
    const Point2 middle{(float(i % kSide) + 0.5f) / kSide, (float(i / kSide) + 0.5f) / kSide};
    const Vec3 h = ggx.sampleVisible(wo, middle), wi = reflect(wo, h);
    if (wi.z > 0.0f) sum += fresnel.at(dot(wo, h)) * (ggx.visible(wo, wi) / ggx.visible(wo));
  }
  return sum * (1.0f / (kSide * kSide));
}

}  // namespace bnvpl
