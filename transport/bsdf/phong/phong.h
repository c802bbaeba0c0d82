// MTL's model: Lambert plus a Phong lobe or a mirror, or smooth glass. Equations: theory.md.
#pragma once

#include "transport/bsdf/lobe.h"

namespace bnvpl {

// Phong lobes with a larger exponent n are specular: alpha = sqrt(2 / (n + 2)) is below 0.3.
inline constexpr float kNearSpecularExponent = 20.0f;

// Share of the light from a direction at this cosine that a Phong lobe reflects: 1 along the
// normal, and less elsewhere (theory.md, eq. 2). Within 0.005.
float phongAlbedo(float cosine, float exponent);

// Modified Phong lobe (Lafortune & Willems 1994). It is reciprocal and reflects at most `colour`.
struct PhongLobe {
  Vec3 colour;
  float exponent = 10.0f;

  bool smooth() const { return false; }
  LobeGroup group() const {
    return exponent > kNearSpecularExponent ? LobeGroup::Specular : LobeGroup::Rough;
  }
  Vec3 value(Vec3 wo, Vec3 wi, TransportMode) const {
    return wi.z > 0.0f ? at(dot(mirrored(wo), wi)) : Vec3{};
  }
  float pdf(Vec3 wo, Vec3 wi) const {
    return wi.z > 0.0f ? pdfPowerCosine(dot(mirrored(wo), wi), exponent) : 0.0f;
  }
  bool sample(Vec3 wo, float, Point2 at, LobeSample& out) const {
    out.wi = Frame(mirrored(wo)).toWorld(samplePowerCosine(at.x, at.y, exponent));
    return out.wi.z > 0.0f;
  }
  Vec3 albedo(Vec3 wo) const { return colour * phongAlbedo(wo.z, exponent); }
  Vec3 bound(Vec3, float maxCosine, float cosMirror) const {
    return at(cosMirror) * std::max(0.0f, maxCosine);
  }

 private:
  Vec3 at(float cosAlpha) const {
    if (cosAlpha <= 0.0f) return {};
    return colour *
           ((exponent + 2.0f) / (2.0f * kPi) * std::pow(std::min(cosAlpha, 1.0f), exponent));
  }
};

std::optional<bool> roughEverywhere(const PhongModel& model);
bool mayBeSpecular(const PhongModel& model);
inline bool isGlass(const PhongModel& model, const Scene&) { return model.glass; }

void addLobes(const PhongModel& model, const MaterialInputs& inputs, Vec3 weight, Bsdf& out);
ModelReport describe(const Scene& scene, const PhongModel& model);
MtlModel toMtl(const Scene& scene, const PhongModel& model);

}  // namespace bnvpl
