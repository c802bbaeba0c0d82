// Matrices of colour spaces and of chromatic adaptation; declared in spectrum.h.
#include <algorithm>
#include <cmath>

#include "scene/primaries.h"
#include "scene/read/pbrt/colors/spectrum.h"

namespace bnvpl::pbrt {

namespace {

constexpr std::array<double, 2> kD60{0.32168, 0.33767};

const Primaries& primariesOf(ColorSpace space) {
  static constexpr Primaries kP3{{0.68, 0.32}, {0.265, 0.69}, {0.15, 0.06}, kD65},
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
  return kRec709;
}

Matrix3 xyzFromRgb(ColorSpace space) { return bnvpl::xyzFromRgb(primariesOf(space)); }

const Matrix3& srgbFromXyz() {
  static const Matrix3 m = inverseOf(xyzFromRgb(ColorSpace::Srgb));
  return m;
}

}  // namespace

Vec3 srgbOf(const Xyz& xyz) { return vec3Of(times(srgbFromXyz(), xyz)); }

Vec3 srgbOfLight(const Vec3& rgb, ColorSpace from) {
  return from == ColorSpace::Srgb ? rgb : srgbOf(times(xyzFromRgb(from), doubles(rgb)));
}

Vec3 srgbOfReflectance(const Vec3& rgb, ColorSpace from) {
  if (from == ColorSpace::Srgb) return rgb;
  const Matrix3 white = adaptation(xyzOf(primariesOf(from).white), xyzOf(kD65));
  return srgbOf(times(white, times(xyzFromRgb(from), doubles(rgb))));
}

std::array<Vec3, 3> whiteBalance(double kelvin) {
  const Matrix3 m = product(
      srgbFromXyz(),
      product(adaptation(xyzOfLight(daylight(kelvin)), xyzOf(kD65)), xyzFromRgb(ColorSpace::Srgb)));
  return {vec3Of(m[0]), vec3Of(m[1]), vec3Of(m[2])};
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
    std::array<double, 2> xy;
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
