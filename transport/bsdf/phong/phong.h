// MTL's model: Lambert plus a Phong lobe or a mirror, or smooth glass. Equations: theory.md.
#pragma once

#include <optional>

#include "transport/bsdf/rough_leaving.h"
#include "transport/bsdf/scatter.h"

namespace bnvpl {

// Phong lobes with a larger exponent n are specular: alpha = sqrt(2 / (n + 2)) is below 0.3.
inline constexpr float kNearSpecularExponent = 20.0f;

class PhongBsdf {
 public:
  PhongBsdf(const Scene& scene, const PhongModel& model, const SurfacePoint& point);
  explicit PhongBsdf(Vec3 albedo) : diffuse_(albedo) {}  // Lambert only

  Vec3 roughAlbedo() const { return diffuse_ + roughGlossy(); }
  Vec3 diffuseValue() const { return diffuse_ * (1.0f / kPi); }
  bool diffuseOnly() const { return isBlack(roughGlossy()); }
  std::optional<RoughLeaving> roughLeaving(const SurfacePoint& point) const {
    return diffuseOnly() ? std::optional(RoughLeaving{point.ng, point.ns}) : std::nullopt;
  }
  DiffusePart diffusePart(const SurfacePoint& point) const {
    return {RoughLeaving{point.ng, point.ns}, diffuseValue()};
  }
  float specularProbability() const { return specularProbability_; }
  bool specularIsDelta() const { return !nearSpecular_; }
  float reflectance() const;

  Vec3 eval(const SurfacePoint& point, LobeGroup group, Vec3 wi) const;
  float pdf(const SurfacePoint& point, LobeGroup group, Vec3 wi) const;
  template <typename MaxCosine>
  Vec3 roughUpperBound(const SurfacePoint& point, float maxCosNs,
                       const MaxCosine& maxCosine) const {
    Vec3 bound = diffuseValue();
    if (!isBlack(roughGlossy())) bound += glossyBound(maxCosine(glossyAxis(point)));
    return bound * std::max(0.0f, maxCosNs);
  }
  static Vec3 glossyAxis(const SurfacePoint& point) { return reflect(point.wo, point.ns); }
  bool sample(const SurfacePoint& point, LobeGroup group, Transport transport, Rng& rng,
              BsdfSample& out) const;
  bool sample(const SurfacePoint& point, LobeGroup group, Transport transport, float pick,
              Point2 at, BsdfSample& out) const;
  static float photonShadingFactor(const SurfacePoint& point) {
    if (point.ns == point.ng) return dot(point.ng, point.wo) > 0.0f ? 1.0f : 0.0f;
    return shadingFactor(point, point.ns);
  }

 private:
  Vec3 roughGlossy() const { return nearSpecular_ ? Vec3{} : glossy_; }
  float groupPdf(LobeGroup group, float cosDiffuse, float cosGlossy) const;
  Vec3 glossyBound(float cosAlpha) const;  // Phong lobe without the cosine
  bool sampleDiffuse(const SurfacePoint& point, bool photons, float shading, Point2 at,
                     BsdfSample& out) const;
  bool sampleGlass(const SurfacePoint& point, Transport transport, Rng& rng, BsdfSample& out) const;

  Vec3 diffuse_, glossy_, mirror_, transmission_;
  float exponent_ = 0.0f, ior_ = 1.5f;
  bool nearSpecular_ = false, glass_ = false;
  float specularProbability_ = 0.0f;
  float diffuseShare_ = 1.0f;  // fraction of the rough samples that the diffuse lobe gets
};

inline bool isNearSpecular(const PhongModel& m) { return m.exponent > kNearSpecularExponent; }
// Whether the model has lobes of the specular group.
inline bool hasSpecularLobes(const PhongModel& m) {
  return m.glass || !isBlack(m.mirror) || (!isBlack(m.glossy) && isNearSpecular(m));
}

}  // namespace bnvpl
