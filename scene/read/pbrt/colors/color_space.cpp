// Matrices of colour spaces and of chromatic adaptation; declared in spectrum.h.
#include <algorithm>
#include <cmath>

#include "scene/read/pbrt/colors/spectrum.h"

namespace bnvpl::pbrt {

namespace {

using Matrix = std::array<std::array<double, 3>, 3>;
using Xy = std::array<double, 2>;

Xyz times(const Matrix& m, const Xyz& v) {
  Xyz out{};
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 3; ++j) out[i] += m[i][j] * v[j];
  }
  return out;
}

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix c{};
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 3; ++j) {
      for (size_t k = 0; k < 3; ++k) c[i][j] += a[i][k] * b[k][j];
    }
  }
  return c;
}

Matrix inverseOf(const Matrix& m) {
  Matrix out;
  double determinant = 0.0;
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 3; ++j) {
      const size_t a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
      out[j][i] = m[a][c] * m[b][d] - m[a][d] * m[b][c];
      if (i == 0) determinant += m[i][j] * out[j][i];
    }
  }
  for (auto& row : out) {
    for (double& v : row) v /= determinant;
  }
  return out;
}

Xyz xyzOf(const Xy& c) { return {c[0] / c[1], 1.0, (1.0 - c[0] - c[1]) / c[1]}; }

constexpr Xy kD65{0.31271, 0.32902}, kD60{0.32168, 0.33767};

struct Primaries {
  Xy red, green, blue, white;
};

const Primaries& primariesOf(ColorSpace space) {
  static constexpr Primaries kSrgb{{0.64, 0.33}, {0.3, 0.6}, {0.15, 0.06}, kD65},
      kP3{{0.68, 0.32}, {0.265, 0.69}, {0.15, 0.06}, kD65},
      kRec2020{{0.708, 0.292}, {0.17, 0.797}, {0.131, 0.046}, kD65},
      kAces{{0.7347, 0.2653}, {0.0, 1.0}, {0.0001, -0.077}, kD60};
  switch (space) {
    case ColorSpace::DciP3:
      return kP3;
    case ColorSpace::Rec2020:
      return kRec2020;
    case ColorSpace::Aces:
      return kAces;
    case ColorSpace::Srgb:
      break;
  }
  return kSrgb;
}

Matrix xyzFromRgb(ColorSpace space) {
  const Primaries& p = primariesOf(space);
  const Xyz r = xyzOf(p.red), g = xyzOf(p.green), b = xyzOf(p.blue);
  Matrix m{{{r[0], g[0], b[0]}, {r[1], g[1], b[1]}, {r[2], g[2], b[2]}}};
  const Xyz weights = times(inverseOf(m), xyzOf(p.white));
  for (auto& row : m) {
    for (size_t j = 0; j < 3; ++j) row[j] *= weights[j];
  }
  return m;
}

// Bradford's matrix from XYZ to cone responses.
constexpr Matrix kBradford{
    {{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}}};

Matrix adaptation(const Xyz& from, const Xyz& to) {
  const Xyz a = times(kBradford, from), b = times(kBradford, to);
  Matrix scaled = kBradford;
  for (size_t i = 0; i < 3; ++i) {
    for (double& v : scaled[i]) v *= b[i] / a[i];
  }
  return product(inverseOf(kBradford), scaled);
}

const Matrix& srgbFromXyz() {
  static const Matrix m = inverseOf(xyzFromRgb(ColorSpace::Srgb));
  return m;
}

Xyz doubles(const Vec3& v) { return {v.x, v.y, v.z}; }
Vec3 floats(const Xyz& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

}  // namespace

Vec3 srgbOf(const Xyz& xyz) { return floats(times(srgbFromXyz(), xyz)); }

Vec3 srgbOfLight(const Vec3& rgb, ColorSpace from) {
  return from == ColorSpace::Srgb ? rgb : srgbOf(times(xyzFromRgb(from), doubles(rgb)));
}

Vec3 srgbOfReflectance(const Vec3& rgb, ColorSpace from) {
  if (from == ColorSpace::Srgb) return rgb;
  const Matrix white = adaptation(xyzOf(primariesOf(from).white), xyzOf(kD65));
  return srgbOf(times(white, times(xyzFromRgb(from), doubles(rgb))));
}

std::array<Vec3, 3> whiteBalance(double kelvin) {
  const Matrix m = product(
      srgbFromXyz(),
      product(adaptation(xyzOfLight(daylight(kelvin)), xyzOf(kD65)), xyzFromRgb(ColorSpace::Srgb)));
  return {floats(m[0]), floats(m[1]), floats(m[2])};
}

Vec3 intoGamut(Vec3 light) {
  const Vec3 clamped = max(light, Vec3{});
  const float wanted = luminance(light), got = luminance(clamped);
  return wanted > 0.0f && got > 0.0f ? clamped * (wanted / got) : clamped;
}

// Chromaticities of ACES's D60 and of the CIE illuminants A, D and F (CIE 15). Only the colour of
// an illuminant counts, since pbrt scales each spectrum to Y = 1.
std::optional<Xyz> namedIlluminant(const std::string& name) {
  struct Named {
    const char* name;
    Xy xy;
  };
  static constexpr Named kIlluminants[]{{"stdillum-A", {0.44757, 0.40745}},
                                        {"stdillum-D50", {0.34567, 0.35850}},
                                        {"stdillum-D65", kD65},
                                        {"illum-acesD60", kD60},
                                        {"stdillum-F1", {0.31310, 0.33727}},
                                        {"stdillum-F2", {0.37208, 0.37529}},
                                        {"stdillum-F3", {0.40910, 0.39430}},
                                        {"stdillum-F4", {0.44018, 0.40329}},
                                        {"stdillum-F5", {0.31379, 0.34531}},
                                        {"stdillum-F6", {0.37790, 0.38835}},
                                        {"stdillum-F7", {0.31292, 0.32933}},
                                        {"stdillum-F8", {0.34588, 0.35875}},
                                        {"stdillum-F9", {0.37417, 0.37281}},
                                        {"stdillum-F10", {0.34609, 0.35986}},
                                        {"stdillum-F11", {0.38052, 0.37713}},
                                        {"stdillum-F12", {0.43695, 0.40441}}};
  for (const Named& known : kIlluminants) {
    if (name == known.name) return xyzOf(known.xy);
  }
  return std::nullopt;
}

}  // namespace bnvpl::pbrt
