// Vec3 is a point, direction, normal or linear-sRGB colour: three packed floats, so that columns of
// it are written to files as they are.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace bnvpl {

struct Vec3 {
  float x = 0.0f, y = 0.0f, z = 0.0f;

  Vec3() = default;
  constexpr Vec3(float x_, float y_, float z_) : x(x_), y(y_), z(z_) {}
  constexpr explicit Vec3(float s) : x(s), y(s), z(s) {}

  // Element access by axis, 0..2.
  constexpr float operator[](size_t axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
  constexpr float& operator[](size_t axis) { return axis == 0 ? x : axis == 1 ? y : z; }

  friend constexpr bool operator==(const Vec3&, const Vec3&) = default;
};
static_assert(sizeof(Vec3) == 12);

constexpr Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
constexpr Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
constexpr Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
constexpr Vec3 operator*(Vec3 a, Vec3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
constexpr Vec3 operator*(Vec3 a, float s) { return {a.x * s, a.y * s, a.z * s}; }
constexpr Vec3 operator*(float s, Vec3 a) { return a * s; }
constexpr Vec3 operator/(Vec3 a, float s) { return {a.x / s, a.y / s, a.z / s}; }
constexpr Vec3& operator+=(Vec3& a, Vec3 b) { return a = a + b; }
constexpr Vec3& operator*=(Vec3& a, Vec3 b) { return a = a * b; }
constexpr Vec3& operator*=(Vec3& a, float s) { return a = a * s; }

constexpr float dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr Vec3 cross(Vec3 a, Vec3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
constexpr float lengthSquared(Vec3 a) { return dot(a, a); }
inline float length(Vec3 a) { return std::sqrt(dot(a, a)); }
inline Vec3 normalize(Vec3 a) { return a / length(a); }
inline Vec3 min(Vec3 a, Vec3 b) {
  return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
inline Vec3 max(Vec3 a, Vec3 b) {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}
inline float maxComponent(Vec3 a) { return std::max(a.x, std::max(a.y, a.z)); }
inline float minComponent(Vec3 a) { return std::min(a.x, std::min(a.y, a.z)); }
constexpr float mean(Vec3 rgb) { return (rgb.x + rgb.y + rgb.z) * (1.0f / 3.0f); }
// Relative luminance of linear sRGB (Rec. 709 primaries).
constexpr float luminance(Vec3 rgb) { return 0.2126f * rgb.x + 0.7152f * rgb.y + 0.0722f * rgb.z; }
constexpr bool isBlack(Vec3 rgb) { return rgb.x == 0.0f && rgb.y == 0.0f && rgb.z == 0.0f; }
inline bool isFinite(Vec3 a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}
// Mirror direction of `w` (pointing away from the surface) about the unit normal `n`.
constexpr Vec3 reflect(Vec3 w, Vec3 n) { return 2.0f * dot(w, n) * n - w; }

// Two unit vectors that complete the unit vector `n` to a right-handed basis (s, t, n).
// Duff et al. 2017, "Building an Orthonormal Basis, Revisited".
struct Frame {
  Vec3 s, t, n;
  explicit Frame(Vec3 normal) : n(normal) {
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1.0f / (sign + n.z);
    const float b = n.x * n.y * a;
    s = {1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x};
    t = {b, sign + n.y * n.y * a, -n.y};
  }
  Vec3 toWorld(Vec3 v) const { return v.x * s + v.y * t + v.z * n; }
  Vec3 toLocal(Vec3 v) const { return {dot(v, s), dot(v, t), dot(v, n)}; }
};

// Axis-aligned box, which is empty until it is extended.
struct Bounds {
  Vec3 lower{INFINITY, INFINITY, INFINITY};
  Vec3 upper{-INFINITY, -INFINITY, -INFINITY};
  void extend(Vec3 p) {
    lower = min(lower, p);
    upper = max(upper, p);
  }
  void extend(const Bounds& b) {
    lower = min(lower, b.lower);
    upper = max(upper, b.upper);
  }
  bool empty() const { return !(lower.x <= upper.x); }
  Vec3 extent() const { return empty() ? Vec3{} : upper - lower; }
  Vec3 center() const { return 0.5f * (lower + upper); }
  float diagonal() const { return length(extent()); }
  // Whether the ray meets the box, which contains its faces.
  bool isHitBy(Vec3 from, Vec3 direction) const {
    float begin = 0.0f, end = INFINITY;
    for (size_t c = 0; c < 3; ++c) {
      if (direction[c] == 0.0f) {
        if (!(from[c] >= lower[c] && from[c] <= upper[c])) return false;
        continue;
      }
      const float a = (lower[c] - from[c]) / direction[c], b = (upper[c] - from[c]) / direction[c];
      begin = std::max(begin, std::min(a, b)), end = std::min(end, std::max(a, b));
    }
    return begin <= end;
  }
  float distanceSquared(Vec3 p) const {
    return lengthSquared(max(max(lower - p, p - upper), Vec3{}));
  }
};

}  // namespace bnvpl
