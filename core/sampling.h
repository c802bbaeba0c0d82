// Warps from the unit square to directions and positions, each next to its density.
#pragma once

#include <array>
#include <numbers>

#include "core/random.h"
#include "core/vec3.h"

namespace bnvpl {

inline constexpr float kPi = std::numbers::pi_v<float>;
inline constexpr double kDegPerRad = 180.0 / std::numbers::pi;

// Sine and cosine by their Taylor series, accurate to one ulp for |x| <= pi / 4, and the same on
// every machine.
constexpr float sineOfEighth(float x) {
  const float s = x * x;
  return x * (1.0f + s * (-1.0f / 6 + s * (1.0f / 120 + s * (-1.0f / 5040 + s / 362880))));
}
constexpr float cosineOfEighth(float x) {
  const float s = x * x;
  return 1.0f + s * (-1.0f / 2 + s * (1.0f / 24 + s * (-1.0f / 720 + s / 40320)));
}

// Uniform on the unit disk, by the concentric map of Shirley & Chiu 1997, which preserves strata.
inline Vec3 sampleDisk(float u, float v) {
  const float a = 2.0f * u - 1.0f, b = 2.0f * v - 1.0f;
  const bool wide = std::fabs(a) > std::fabs(b);
  const float r = wide ? a : b, other = wide ? b : a;
  if (r == 0.0f) return {};
  const float phi = kPi / 4.0f * (other / r);  // angle from the nearest axis
  const float along = r * cosineOfEighth(phi), across = r * sineOfEighth(phi);
  return wide ? Vec3{along, across, 0.0f} : Vec3{across, along, 0.0f};
}

// Cosine-weighted direction about +z.
inline Vec3 sampleCosineHemisphere(float u, float v) {
  const Vec3 d = sampleDisk(u, v);
  return {d.x, d.y, std::sqrt(std::max(0.0f, 1.0f - d.x * d.x - d.y * d.y))};
}
// The inverses.
inline Point2 invertDiskSample(Vec3 p) {
  const bool wide = std::fabs(p.x) > std::fabs(p.y);
  const float along = wide ? p.x : p.y, across = wide ? p.y : p.x;
  if (along == 0.0f) return {0.5f, 0.5f};
  const float r = std::copysign(std::min(1.0f, std::sqrt(p.x * p.x + p.y * p.y)), along);
  const float other = r * std::atan(across / along) * (4.0f / kPi);
  const float a = wide ? r : other, b = wide ? other : r;
  return {0.5f * (a + 1.0f), 0.5f * (b + 1.0f)};
}
// The sample that becomes goldenPoint(index) in polar coordinates of the disk, so that cosines of
// the hemisphere have the strata of y.
inline Point2 goldenDiskSample(uint32_t index) {
  static const std::array<Point2, kGoldenPoints> samples = [] {
    std::array<Point2, kGoldenPoints> all;
    for (uint32_t i = 0; i < kGoldenPoints; ++i) {
      const Point2 at = goldenPoint(i);
      const float r = std::sqrt(at.y), phi = 2.0f * kPi * at.x;
      all[i] = invertDiskSample({r * std::cos(phi), r * std::sin(phi), 0.0f});
    }
    return all;
  }();
  return samples[index];
}
inline Point2 invertCosineHemisphereSample(Vec3 d) { return invertDiskSample(d); }
inline float pdfCosineHemisphere(float cosTheta) { return std::max(0.0f, cosTheta) / kPi; }

// Uniform on the sphere; density 1/(4 pi).
inline Vec3 sampleSphere(float u, float v) {
  const float z = 1.0f - 2.0f * u;
  const float r = std::sqrt(std::max(0.0f, 1.0f - z * z));
  return {r * std::cos(2.0f * kPi * v), r * std::sin(2.0f * kPi * v), z};
}

// The inverse of sampleSphere().
inline Point2 invertSphereSample(Vec3 d) {
  const float turns = std::atan2(d.y, d.x) / (2.0f * kPi);
  return {0.5f * (1.0f - d.z), turns < 0.0f ? turns + 1.0f : turns};
}

// Uniform in the cone about +z with the given cosine of its half angle; density pdfCone(), 1/sr.
inline Vec3 sampleCone(float u, float v, float cosHalfAngle) {
  const float z = 1.0f - u * (1.0f - cosHalfAngle);
  const float r = std::sqrt(std::max(0.0f, 1.0f - z * z));
  return {r * std::cos(2.0f * kPi * v), r * std::sin(2.0f * kPi * v), z};
}

// cos^n lobe about +z; density (n + 1) / (2 pi) cos^n.
inline Vec3 samplePowerCosine(float u, float v, float exponent) {
  const float z = std::pow(u, 1.0f / (exponent + 1.0f));
  const float r = std::sqrt(std::max(0.0f, 1.0f - z * z));
  return {r * std::cos(2.0f * kPi * v), r * std::sin(2.0f * kPi * v), z};
}
inline float pdfPowerCosine(float cosAlpha, float exponent) {
  if (cosAlpha <= 0.0f) return 0.0f;
  return (exponent + 1.0f) / (2.0f * kPi) * std::pow(std::min(cosAlpha, 1.0f), exponent);
}

// Uniform barycentric coordinates (of the second and third corner); density 1/area.
struct Barycentric {
  float u, v;
};
inline Barycentric sampleTriangle(float u, float v) {
  const float root = std::sqrt(u);
  return {root * (1.0f - v), root * v};
}

// The inverse of sampleTriangle().
inline Point2 invertTriangleSample(Barycentric b) {
  const float root = std::min(1.0f, b.u + b.v);
  return {root * root, root > 0.0f ? std::min(1.0f, b.v / root) : 0.0f};
}

// Power heuristic with exponent 2 (Veach 1997, eq. 9.13) for the technique with density `a`.
// Doubles hold the squares of the densities of small or distant lights, which overflow floats.
inline float powerHeuristic(float a, float b) {
  if (std::isinf(a)) return 1.0f;
  const double a2 = double{a} * double{a}, b2 = double{b} * double{b};
  return a2 > 0.0 ? static_cast<float>(a2 / (a2 + b2)) : 0.0f;
}

}  // namespace bnvpl
