// The colour spaces of FLIP: linear sRGB, YCxCz and Hunt-adjusted CIELAB.
//   [A20] Andersson et al. 2020, "FLIP: A Difference Evaluator for Alternating Images"
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "core/vec3.h"

namespace bnvpl::flip {

using Matrix3 = std::array<std::array<double, 3>, 3>;

// CIE XYZ from linear sRGB, from Image Engineering technote 958 as in the authors' implementation.
// The matrix differs from IEC 61966-2-1 in the fifth digit.
inline constexpr Matrix3 kXyzFromRgb{
    {{0.4123865632529917, 0.3575914909206253, 0.1804504912035637},
     {0.2126368216773238, 0.7151829818412507, 0.0721801964814255},
     {0.0193306201524840, 0.1191971636402082, 0.9503725870054354}}};

// FLIP uses XYZ relative to the white point, which is the XYZ of R = G = B = 1.
constexpr Matrix3 relativeToWhite(Matrix3 m) {
  for (auto& row : m) {
    const double white = row[0] + row[1] + row[2];
    for (double& v : row) v /= white;
  }
  return m;
}

constexpr Matrix3 inverse(const Matrix3& m) {
  Matrix3 cofactors{};
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 3; ++j) {
      const size_t a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
      cofactors[i][j] = m[a][c] * m[b][d] - m[a][d] * m[b][c];
    }
  }
  const double determinant =
      m[0][0] * cofactors[0][0] + m[0][1] * cofactors[0][1] + m[0][2] * cofactors[0][2];
  Matrix3 result{};
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 3; ++j) result[i][j] = cofactors[j][i] / determinant;
  }
  return result;
}

inline constexpr Matrix3 kWhiteXyzFromRgb = relativeToWhite(kXyzFromRgb);
inline constexpr Matrix3 kRgbFromWhiteXyz = inverse(kWhiteXyzFromRgb);

inline Vec3 multiply(const Matrix3& m, Vec3 v) {
  const auto row = [&](size_t i) {
    return static_cast<float>(m[i][0]) * v.x + static_cast<float>(m[i][1]) * v.y +
           static_cast<float>(m[i][2]) * v.z;
  };
  return {row(0), row(1), row(2)};
}

// YCxCz, the linear opponent space of the filters in [A20].
inline Vec3 yCxCzFromRgb(Vec3 rgb) {
  const Vec3 w = multiply(kWhiteXyzFromRgb, rgb);
  return {116.0f * w.y - 16.0f, 500.0f * (w.x - w.y), 200.0f * (w.y - w.z)};
}
inline Vec3 rgbFromYCxCz(Vec3 c) {
  const float y = (c.x + 16.0f) / 116.0f;
  return multiply(kRgbFromWhiteXyz, {y + c.y / 500.0f, y, y - c.z / 200.0f});
}

// L*, a*, b* (CIE 1976), with a* and b* scaled by L* / 100, because colours are less visible in the
// dark (the Hunt effect, [A20]).
inline Vec3 huntLabFromRgb(Vec3 rgb) {
  constexpr float kDelta = 6.0f / 29.0f;
  const auto f = [](float t) {
    return t > kDelta * kDelta * kDelta ? std::cbrt(t)
                                        : t / (3.0f * kDelta * kDelta) + 4.0f / 29.0f;
  };
  const Vec3 w = multiply(kWhiteXyzFromRgb, rgb);
  const float fx = f(w.x), fy = f(w.y), fz = f(w.z);
  const float l = 116.0f * fy - 16.0f, hunt = 0.01f * l;
  return {l, hunt * 500.0f * (fx - fy), hunt * 200.0f * (fy - fz)};
}

// The HyAB distance (Abasi et al. 2020): the sum of the distances in lightness and in chromaticity.
inline float hyab(Vec3 a, Vec3 b) {
  const Vec3 d = a - b;
  return std::fabs(d.x) + std::sqrt(d.y * d.y + d.z * d.z);
}

}  // namespace bnvpl::flip
