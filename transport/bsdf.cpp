#include "transport/bsdf.h"

#include <cmath>

#include "core/sampling.h"

namespace bnvpl {

namespace {

// So grazing that one photon would outweigh all others: no surface has such shading normals.
constexpr float kMaxShadingFactor = 1e5f;

bool isSharp(const PhongModel& m) { return m.exponent > kSharpExponent; }

// Unpolarised Fresnel reflectance of a smooth dielectric; cosI >= 0, eta = n_transmitted /
// n_incident. Sets the cosine of the refracted direction; 1 under total internal reflection.
float fresnel(float cosI, float eta, float& cosT) {
  const float sin2T = (1.0f - cosI * cosI) / (eta * eta);
  if (sin2T >= 1.0f) return 1.0f;
  cosT = std::sqrt(1.0f - sin2T);
  const float parallel = (eta * cosI - cosT) / (eta * cosI + cosT);
  const float perpendicular = (cosI - eta * cosT) / (cosI + eta * cosT);
  return 0.5f * (parallel * parallel + perpendicular * perpendicular);
}

}  // namespace

bool hasSpecularLobes(const Scene& scene) {
  for (const Material& material : scene.materials) {
    const PhongModel& m = material.phong();
    if (m.glass || !isBlack(m.mirror) || (!isBlack(m.glossy) && isSharp(m))) return true;
  }
  return false;
}

Bsdf::Bsdf(const Scene& scene, const SurfacePoint& point) : point_(point) {
  const PhongModel& m = scene.materials[point.material].phong();
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
  sharp_ = isSharp(m) && !isBlack(glossy_);
  if (const float sum = maxComponent(diffuse_ + glossy_ + mirror_); sum > 1.0f) {
    diffuse_ *= 1.0f / sum;
    glossy_ *= 1.0f / sum;
    mirror_ *= 1.0f / sum;
  }
  const float rough = maxComponent(roughAlbedo());
  const float chain = maxComponent(mirror_ + (sharp_ ? glossy_ : Vec3{}));
  if (chain > 0.0f) specularProbability_ = chain / (chain + rough);
  if (specularProbability_ < kMinProbability) specularProbability_ = 0.0f;
  const float d = maxComponent(diffuse_), g = maxComponent(roughGlossy());
  if (g > 0.0f) diffuseShare_ = d / (d + g);
}

float Bsdf::reflectance() const {
  if (glass_) return 1.0f;
  const float largest = std::min(1.0f, maxComponent(diffuse_ + glossy_ + mirror_));
  return largest < kMinProbability ? 0.0f : largest;
}

float Bsdf::photonShadingFactor() const {
  if (point_.ns == point_.ng) return dot(point_.ng, point_.wo) > 0.0f ? 1.0f : 0.0f;
  const float geometric = dot(point_.ng, point_.wo);
  if (!(geometric > 0.0f)) return 0.0f;
  return std::min(kMaxShadingFactor, std::max(0.0f, dot(point_.ns, point_.wo)) / geometric);
}

// Modified Phong (Lafortune & Willems 1994): reciprocal, and never reflects more than Ks.
Vec3 Bsdf::glossyBound(float cosAlpha) const {
  if (cosAlpha <= 0.0f) return {};
  return glossy_ *
         ((exponent_ + 2.0f) / (2.0f * kPi) * std::pow(std::min(cosAlpha, 1.0f), exponent_));
}

Vec3 Bsdf::eval(LobeGroup group, Vec3 wi) const {
  const float cosine = dot(point_.ns, wi);
  if (glass_ || dot(point_.ng, wi) <= 0.0f || cosine <= 0.0f) return {};
  Vec3 value = group == LobeGroup::Rough ? diffuseValue() : Vec3{};
  if (sharp_ == (group == LobeGroup::Specular) && !isBlack(glossy_))
    value += glossyBound(dot(glossyAxis(), wi));
  return value * cosine;
}

float Bsdf::pdf(LobeGroup group, Vec3 wi) const {
  if (glass_ || dot(point_.ng, wi) <= 0.0f) return 0.0f;
  if (group == LobeGroup::Specular && !sharp_) return 0.0f;
  return groupPdf(group, dot(point_.ns, wi), dot(glossyAxis(), wi));
}

// By the cosines to the diffuse lobe's axis and the glossy one's.
float Bsdf::groupPdf(LobeGroup group, float cosDiffuse, float cosGlossy) const {
  if (group == LobeGroup::Specular) return pdfPowerCosine(cosGlossy, exponent_);
  const float diffusePdf = pdfCosineHemisphere(cosDiffuse);
  if (diffuseShare_ >= 1.0f) return diffusePdf;
  return diffuseShare_ * diffusePdf + (1.0f - diffuseShare_) * pdfPowerCosine(cosGlossy, exponent_);
}

bool Bsdf::sampleGlass(Transport transport, Rng& rng, BsdfSample& out) const {
  const float eta = point_.front ? ior_ : 1.0f / ior_;
  // The side test of refraction needs one normal for cosine and side: the shading normal where it
  // faces the ray, else the geometric one.
  const Vec3 n = dot(point_.ns, point_.wo) > 0.0f ? point_.ns : point_.ng;
  const float cosI = std::min(1.0f, dot(n, point_.wo));
  float cosT = 0.0f;
  const float reflected = fresnel(cosI, eta, cosT);
  out.pdf = 0.0f;
  if (rng.next() < reflected) {
    out.wi = reflect(point_.wo, n);
    out.weight = mirror_;
    out.side = point_.ng;
    return dot(out.wi, point_.ng) > 0.0f;
  }
  out.wi = normalize(n * (cosI / eta - cosT) - point_.wo * (1.0f / eta));
  // Radiance is squeezed by refraction, flux is not (Veach 1997, section 5.2).
  out.weight =
      transport == Transport::Radiance ? transmission_ * (1.0f / (eta * eta)) : transmission_;
  out.side = -point_.ng;
  return dot(out.wi, point_.ng) < 0.0f;
}

bool Bsdf::sample(LobeGroup group, Transport transport, Rng& rng, BsdfSample& out) const {
  if (glass_) return group == LobeGroup::Specular && sampleGlass(transport, rng, out);
  const float pick = rng.next(), u = rng.next(), v = rng.next();
  return sample(group, transport, pick, {u, v}, out);
}
// Where there is no other lobe, all but the albedo cancels. A photon leaves by the geometric
// cosine, so that its weight stays the albedo.
bool Bsdf::sampleDiffuse(bool photons, float shading, Point2 at, BsdfSample& out) const {
  const Vec3 axis = photons ? point_.ng : point_.ns;
  out.wi = Basis(axis).toWorld(sampleCosineHemisphere(at.x, at.y));
  out.pdf = pdfCosineHemisphere(dot(axis, out.wi));
  out.weight = diffuse_ * shading;
  return dot(point_.ng, out.wi) > 0.0f && out.pdf > 0.0f && !isBlack(out.weight);
}

bool Bsdf::sample(LobeGroup group, Transport transport, float pick, Point2 at,
                  BsdfSample& out) const {
  if (glass_) return false;
  const bool photons = transport == Transport::Photons;
  const Vec3 ng = point_.ng, ns = point_.ns;
  const float shading = photons ? photonShadingFactor() : 1.0f;
  if (shading == 0.0f) return false;
  out.side = ng;
  if (group == LobeGroup::Rough && diffuseOnly()) return sampleDiffuse(photons, shading, at, out);
  const Vec3 lobeAxis = glossyAxis();

  if (group == LobeGroup::Specular && !sharp_) {
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
    // A photon leaves by the geometric cosine, so that its weight stays the albedo.
    out.wi = Basis(photons ? ng : ns).toWorld(sampleCosineHemisphere(at.x, at.y));
  }
  const float cosGeometric = dot(ng, out.wi), cosShading = dot(ns, out.wi);
  if (cosGeometric <= 0.0f) return false;
  out.pdf = groupPdf(group, photons ? cosGeometric : cosShading, dot(lobeAxis, out.wi));
  if (!(out.pdf > 0.0f)) return false;
  Vec3 value = group == LobeGroup::Rough ? diffuseValue() : Vec3{};
  if (sharp_ == (group == LobeGroup::Specular) && !isBlack(glossy_))
    value += glossyBound(dot(lobeAxis, out.wi));
  const float cosine = photons ? cosGeometric * shading : std::max(0.0f, cosShading);
  out.weight = value * (cosine / out.pdf);
  return !isBlack(out.weight);
}

}  // namespace bnvpl
