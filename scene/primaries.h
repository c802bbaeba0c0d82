// Colour spaces of RGB, and the matrices that lead from one to another.
#pragma once

#include <array>
#include <optional>

#include "core/vec3.h"

namespace bnvpl {

using Matrix3 = std::array<std::array<double, 3>, 3>;
using Xyz = std::array<double, 3>;  // CIE 1931

Xyz times(const Matrix3& m, const Xyz& v);
Matrix3 product(const Matrix3& a, const Matrix3& b);
Matrix3 inverseOf(const Matrix3& m);

// The CIE x and y of the primaries and of white.
struct Primaries {
  std::array<double, 2> red, green, blue, white;
};
inline constexpr std::array<double, 2> kD65{0.31271, 0.32902};
inline constexpr Primaries kRec709{{0.64, 0.33}, {0.3, 0.6}, {0.15, 0.06}, kD65};

// XYZ of a chromaticity, with Y = 1.
Xyz xyzOf(const std::array<double, 2>& xy);
// The matrix from RGB to XYZ, in which white has Y = 1.
Matrix3 xyzFromRgb(const Primaries& p);
// The matrix that takes the white `from` to `to` (Bradford).
Matrix3 adaptation(const Xyz& from, const Xyz& to);

// The matrix to linear Rec. 709, in which white stays white (Bradford). Returns nothing if the
// primaries are no triangle around a white.
std::optional<Matrix3> rec709From(const Primaries& p);
// Whether these are the primaries and white of Rec. 709, rounded to three digits or more.
bool isRec709(const Primaries& p);

inline Xyz doubles(const Vec3& v) { return {v.x, v.y, v.z}; }
inline Vec3 vec3Of(const Xyz& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

}  // namespace bnvpl
