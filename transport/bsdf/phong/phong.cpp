#include "transport/bsdf/phong/phong.h"

#include <cmath>

#include "transport/bsdf/fresnel.h"

namespace bnvpl {

PhongBsdf::PhongBsdf(const Scene& scene, const PhongModel& m, const SurfacePoint& point) {
  glass_ = m.glass;
  mirror_ = m.mirror;
  if (glass_) {
    transmission_ = m.transmission;
    ior_ = m.ior;
    specularProbability_ = 1.0f;
    return;
  }
  const bool hasUv = point.u == point.u;
  diffuse_ = m.diffuseMap != kNone && hasUv
                 ? m.diffuse * scene.textures[m.diffuseMap].lookup(point.u, point.v)
                 : m.diffuse;
  glossy_ = m.glossy;
  if (m.glossyMap != kNone && hasUv) {
    const Vec3 k = scene.textures[m.glossyMap].lookup(point.u, point.v);
    glossy_ *= k;
    mirror_ *= k;
  }
  exponent_ = m.exponent;
  nearSpecular_ = isNearSpecular(m) && !isBlack(glossy_);
  if (const float sum = maxComponent(diffuse_ + glossy_ + mirror_); sum > 1.0f) {
    diffuse_ *= 1.0f / sum;
    glossy_ *= 1.0f / sum;
    mirror_ *= 1.0f / sum;
  }
  const float rough = maxComponent(roughAlbedo());
  const float chain = maxComponent(mirror_ + (nearSpecular_ ? glossy_ : Vec3{}));
  if (chain > 0.0f) specularProbability_ = chain / (chain + rough);
  if (specularProbability_ < kMinProbability) specularProbability_ = 0.0f;
  const float d = maxComponent(diffuse_), g = maxComponent(roughGlossy());
  if (g > 0.0f) diffuseShare_ = d / (d + g);
}

float PhongBsdf::reflectance() const {
  if (glass_) return 1.0f;
  const float largest = std::min(1.0f, maxComponent(diffuse_ + glossy_ + mirror_));
  return largest < kMinProbability ? 0.0f : largest;
}

// Modified Phong lobe (Lafortune & Willems 1994): it is reciprocal and reflects at most Ks.
Vec3 PhongBsdf::glossyBound(float cosAlpha) const {
  if (cosAlpha <= 0.0f) return {};
  return glossy_ *
         ((exponent_ + 2.0f) / (2.0f * kPi) * std::pow(std::min(cosAlpha, 1.0f), exponent_));
}

Vec3 PhongBsdf::eval(const SurfacePoint& point, LobeGroup group, Vec3 wi) const {
  const float cosine = dot(point.ns, wi);
  if (glass_ || dot(point.ng, wi) <= 0.0f || cosine <= 0.0f) return {};
  Vec3 value = group == LobeGroup::Rough ? diffuseValue() : Vec3{};
  if (nearSpecular_ == (group == LobeGroup::Specular) && !isBlack(glossy_))
    value += glossyBound(dot(glossyAxis(point), wi));
  return value * cosine;
}

float PhongBsdf::pdf(const SurfacePoint& point, LobeGroup group, Vec3 wi) const {
  if (glass_ || dot(point.ng, wi) <= 0.0f) return 0.0f;
  if (group == LobeGroup::Specular && !nearSpecular_) return 0.0f;
  return groupPdf(group, dot(point.ns, wi), dot(glossyAxis(point), wi));
}

// Density of the group's samples, from the cosines with the axes of the diffuse and the glossy
// lobe.
float PhongBsdf::groupPdf(LobeGroup group, float cosDiffuse, float cosGlossy) const {
  if (group == LobeGroup::Specular) return pdfPowerCosine(cosGlossy, exponent_);
  const float diffusePdf = pdfCosineHemisphere(cosDiffuse);
  if (diffuseShare_ >= 1.0f) return diffusePdf;
  return diffuseShare_ * diffusePdf + (1.0f - diffuseShare_) * pdfPowerCosine(cosGlossy, exponent_);
}

bool PhongBsdf::sampleGlass(const SurfacePoint& point, Transport transport, Rng& rng,
                            BsdfSample& out) const {
  const float eta = point.front ? ior_ : 1.0f / ior_;
  // Refraction takes cosine and side from one normal: the shading normal where it faces the ray,
  // else the geometric one.
  const Vec3 n = dot(point.ns, point.wo) > 0.0f ? point.ns : point.ng;
  const float cosI = std::min(1.0f, dot(n, point.wo));
  float cosT = 0.0f;
  const float reflected = fresnelDielectric(cosI, eta, cosT);
  out.pdf = 0.0f;
  if (rng.next() < reflected) {
    out.wi = reflect(point.wo, n);
    out.weight = mirror_;
    out.side = point.ng;
    return dot(out.wi, point.ng) > 0.0f;
  }
  out.wi = normalize(n * (cosI / eta - cosT) - point.wo * (1.0f / eta));
  // Refraction scales radiance by 1/eta^2, and leaves flux unchanged (Veach 1997, section 5.2).
  out.weight =
      transport == Transport::Radiance ? transmission_ * (1.0f / (eta * eta)) : transmission_;
  out.side = -point.ng;
  return dot(out.wi, point.ng) < 0.0f;
}

bool PhongBsdf::sample(const SurfacePoint& point, LobeGroup group, Transport transport, Rng& rng,
                       BsdfSample& out) const {
  if (glass_) return group == LobeGroup::Specular && sampleGlass(point, transport, rng, out);
  const float pick = rng.next();
  return sample(point, group, transport, pick, rng.nextPoint(), out);
}
// Without another lobe, everything except the albedo cancels. Photons are drawn by the geometric
// cosine, so that their weight is the albedo times the shading factor.
bool PhongBsdf::sampleDiffuse(const SurfacePoint& point, bool photons, float shading, Point2 at,
                              BsdfSample& out) const {
  const Vec3 axis = photons ? point.ng : point.ns;
  out.wi = Basis(axis).toWorld(sampleCosineHemisphere(at.x, at.y));
  out.pdf = pdfCosineHemisphere(dot(axis, out.wi));
  out.weight = diffuse_ * shading;
  return dot(point.ng, out.wi) > 0.0f && out.pdf > 0.0f && !isBlack(out.weight);
}

bool PhongBsdf::sample(const SurfacePoint& point, LobeGroup group, Transport transport, float pick,
                       Point2 at, BsdfSample& out) const {
  if (glass_) return false;
  const bool photons = transport == Transport::Photons;
  const Vec3 ng = point.ng, ns = point.ns;
  const float shading = photons ? photonShadingFactor(point) : 1.0f;
  if (shading == 0.0f) return false;
  out.side = ng;
  if (group == LobeGroup::Rough && diffuseOnly())
    return sampleDiffuse(point, photons, shading, at, out);
  const Vec3 lobeAxis = glossyAxis(point);

  if (group == LobeGroup::Specular && !nearSpecular_) {
    out.wi = lobeAxis;
    out.weight = mirror_ * shading;
    if (photons) out.weight *= dot(ng, out.wi) / std::max(1e-6f, dot(ns, out.wi));
    out.pdf = 0.0f;
    return dot(out.wi, ng) > 0.0f;
  }
  const bool glossyLobe = group == LobeGroup::Specular || pick >= diffuseShare_;
  if (glossyLobe) {
    out.wi = Basis(lobeAxis).toWorld(samplePowerCosine(at.x, at.y, exponent_));
  } else {
    // Photons are drawn by the geometric cosine, as in sampleDiffuse().
    out.wi = Basis(photons ? ng : ns).toWorld(sampleCosineHemisphere(at.x, at.y));
  }
  const float cosGeometric = dot(ng, out.wi), cosShading = dot(ns, out.wi);
  if (cosGeometric <= 0.0f) return false;
  out.pdf = groupPdf(group, photons ? cosGeometric : cosShading, dot(lobeAxis, out.wi));
  if (!(out.pdf > 0.0f)) return false;
  Vec3 value = group == LobeGroup::Rough ? diffuseValue() : Vec3{};
  if (nearSpecular_ == (group == LobeGroup::Specular) && !isBlack(glossy_))
    value += glossyBound(dot(lobeAxis, out.wi));
  const float cosine = photons ? cosGeometric * shading : std::max(0.0f, cosShading);
  out.weight = value * (cosine / out.pdf);
  return !isBlack(out.weight);
}

}  // namespace bnvpl
