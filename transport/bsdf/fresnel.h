// Fresnel reflectance of smooth interfaces for unpolarised light.
#pragma once

#include "core/vec3.h"

namespace bnvpl {

// Dielectric interface with cosI >= 0 and eta = n_transmitted / n_incident. Sets cosT, the cosine
// of the refracted direction; total internal reflection returns 1 and leaves cosT as it is.
inline float fresnelDielectric(float cosI, float eta, float& cosT) {
  const float sin2T = (1.0f - cosI * cosI) / (eta * eta);
  if (sin2T >= 1.0f) return 1.0f;
  cosT = std::sqrt(1.0f - sin2T);
  const float parallel = (eta * cosI - cosT) / (eta * cosI + cosT);
  const float perpendicular = (cosI - eta * cosT) / (cosI + eta * cosT);
  return 0.5f * (parallel * parallel + perpendicular * perpendicular);
}
inline float fresnelDielectric(float cosI, float eta) {
  float cosT = 0.0f;
  return fresnelDielectric(cosI, eta, cosT);
}

// Cosine behind an interface of a direction with the given cosine before it (Snell's law); eta
// >= 1.
inline float refractedCosine(float cosI, float eta) {
  return std::sqrt(std::max(0.0f, 1.0f - (1.0f - cosI * cosI) / (eta * eta)));
}

// Metal of complex index eta + i k (Lagarde 2013, "Memo on Fresnel equations", after Born & Wolf).
inline float fresnelConductor(float cosI, float eta, float k) {
  const float cos2 = cosI * cosI, sin2 = 1.0f - cos2, eta2 = eta * eta, k2 = k * k;
  const float t0 = eta2 - k2 - sin2, a2b2 = std::sqrt(t0 * t0 + 4.0f * eta2 * k2);
  const float t1 = a2b2 + cos2, a = std::sqrt(std::max(0.0f, 0.5f * (a2b2 + t0)));
  const float t2 = 2.0f * a * cosI, s = (t1 - t2) / std::max(1e-20f, t1 + t2);
  const float t3 = cos2 * a2b2 + sin2 * sin2, t4 = t2 * sin2;
  const float p = s * (t3 - t4) / std::max(1e-20f, t3 + t4);
  return std::min(1.0f, 0.5f * (p + s));
}
inline Vec3 fresnelConductor(float cosI, Vec3 eta, Vec3 k) {
  return {fresnelConductor(cosI, eta.x, k.x), fresnelConductor(cosI, eta.y, k.y),
          fresnelConductor(cosI, eta.z, k.z)};
}

inline float schlickWeight(float cosI) {
  const float m = std::min(1.0f, std::max(0.0f, 1.0f - cosI)), m2 = m * m;
  return m2 * m2 * m;
}

}  // namespace bnvpl
