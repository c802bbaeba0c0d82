// Directions and extents of the lights of Scene::lights.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/sampling.h"
#include "scene/scene.h"

namespace bnvpl {

// Projected areas of a box's faces along a unit direction, by axis.
inline Vec3 projectedFaces(const Bounds& box, Vec3 direction) {
  const Vec3 e = box.extent();
  return {std::fabs(direction.x) * e.y * e.z, std::fabs(direction.y) * e.x * e.z,
          std::fabs(direction.z) * e.x * e.y};
}
// Projected area of the box, which a distant light's photons cover.
inline float silhouetteArea(const Bounds& box, Vec3 direction) {
  const Vec3 faces = projectedFaces(box, direction);
  return faces.x + faces.y + faces.z;
}

// Directions of an environment image: u turns about +y from +z over -x and -z, the image's
// centre, to +x; v goes down from +y. As for a mesh, rotate_deg turns the image by the right-hand
// rule.
inline Vec3 directionOf(const LightSpec& s, float u, float v) {
  const float phi = 2.0f * kPi * (u - 0.5f) - s.rotateRad, theta = kPi * v;
  return {std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)};
}
inline void texelOf(const LightSpec& s, Vec3 d, float& u, float& v) {
  const float turns = (std::atan2(d.x, -d.z) + s.rotateRad) / (2.0f * kPi) + 0.5f;
  u = std::min(turns - std::floor(turns), 0x1.fffffep-1f);
  // acos(d.y) would have few bits left near the poles.
  v = std::min(std::atan2(std::sqrt(d.x * d.x + d.z * d.z), d.y) / kPi, 0x1.fffffep-1f);
}

// Difference of the cosines of the polar angles that bound a row of texels. It is computed as a
// product, because near the poles of a fine image both cosines round to 1.
inline float bandHeight(uint32_t row, uint32_t rows) {
  const double half = 0.5 * double{kPi} / static_cast<double>(rows);
  return static_cast<float>(2.0 * std::sin((2.0 * row + 1.0) * half) * std::sin(half));
}

// The v of a point in a row of texels, where cosines of polar angles grow linearly: at its top for
// share 0, at its bottom for 1. Angles count from the nearer pole, as bandHeight() does.
inline float sampleRow(uint32_t row, uint32_t rows, float share) {
  const bool upper = 2 * row < rows;
  const float edge = std::sin(0.5f * kPi * float(upper ? row : rows - 1 - row) / float(rows));
  const float haversine =
      edge * edge + 0.5f * (upper ? share : 1.0f - share) * bandHeight(row, rows);
  const float polar = 2.0f / kPi * std::asin(std::sqrt(std::min(1.0f, haversine)));
  return upper ? polar : 1.0f - polar;
}
// The inverse.
inline float invertRow(uint32_t row, uint32_t rows, float v) {
  const float top = float(row) / float(rows);
  const float fromTop =
      2.0f * std::sin(0.5f * kPi * (v + top)) * std::sin(0.5f * kPi * (v - top));
  return std::clamp(fromTop / bandHeight(row, rows), 0.0f, 1.0f);
}

inline float texelSolidAngle(const EnvironmentImage& image, uint32_t row) {
  return 2.0f * kPi / float(image.width) * bandHeight(row, image.height);
}

// 1 - cos of a cone's half angle. It keeps its precision where the cosine rounds to 1: in a float,
// the cosine has 8 bits left at the sun's 0.27 degrees, and none below 0.014.
inline float versine(float angleRad) {
  const float s = std::sin(0.5f * angleRad);
  return 2.0f * s * s;
}
inline float versineBetween(Vec3 a, Vec3 b) { return 0.5f * lengthSquared(a - b); }  // unit vectors
inline Vec3 sampleNarrowCone(float u, float v, float coneVersine) {
  const float w = u * coneVersine, r = std::sqrt(w * (2.0f - w));
  return {r * std::cos(2.0f * kPi * v), r * std::sin(2.0f * kPi * v), 1.0f - w};
}
// The inverse of sampleNarrowCone() for a direction about +z.
inline Point2 invertNarrowConeSample(Vec3 d, float coneVersine) {
  const float turns = std::atan2(d.y, d.x) / (2.0f * kPi);
  return {std::min(1.0f, versineBetween(d, {0, 0, 1}) / coneVersine),
          turns < 0.0f ? turns + 1.0f : turns};
}
inline float pdfNarrowCone(float coneVersine) { return 1.0f / (2.0f * kPi * coneVersine); }
inline bool inNarrowCone(Vec3 direction, Vec3 axis, float coneVersine) {
  return versineBetween(direction, axis) <= coneVersine;
}

// Smoothstep of the cosine across the rim, as in pbrt and Cycles. `fromAxis`: versine of the angle
// to the spot's axis.
inline float spotFalloff(const LightSpec& s, float fromAxis) {
  const float outer = versine(s.coneRad);
  if (fromAxis >= outer) return 0.0f;
  const float inner = versine(s.coneRad - s.falloffRad);
  if (fromAxis <= inner) return 1.0f;
  const float t = (outer - fromAxis) / (outer - inner);
  return t * t * (3.0f - 2.0f * t);
}
// Integral of the falloff over directions: the rim counts half.
inline float spotSolidAngle(const LightSpec& s) {
  return kPi * (versine(s.coneRad) + versine(s.coneRad - s.falloffRad));
}

inline Vec3 sunRadiance(const LightSpec& s) {  // irradiance = radiance * pi sin^2(angular radius)
  const float sine = std::sin(s.angularRadiusRad);
  return s.emission * (1.0f / (kPi * sine * sine));
}

}  // namespace bnvpl
