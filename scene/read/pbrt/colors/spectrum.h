// Spectra and their conversion to the linear sRGB of pbrt's film.
//
// pbrt renders wavelengths and integrates them with the CIE 1931 observer; its colour space then
// converts XYZ to linear RGB, without adaptation. For one surface under one light the result here
// is the same. Light that is reflected by several coloured surfaces differs, as always between RGB
// and spectral rendering (docs/scenes.md).
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/errors.h"
#include "core/vec3.h"
#include "scene/primaries.h"
#include "scene/read/pbrt/syntax/params.h"

namespace bnvpl::pbrt {

// A spectrum that is linear between samples. As in pbrt, those of files and parameters are 0 beyond
// them, and those that have a name are constant.
struct Spectrum {
  std::vector<double> nm;  // ascending
  std::vector<double> value;
  bool constantBeyond = true;
  double at(double wavelength) const;
};

// Converts samples "nm value nm value ..." of a parameter or file; nothing if they are no spectrum.
std::optional<Spectrum> spectrumOf(const std::vector<double>& pairs);
// Reads a text of such pairs; '#' begins a comment. Throws InputError.
Spectrum readSpd(const fs::path& file);

Spectrum blackbody(double kelvin);
// CIE daylight of a correlated colour temperature; a blackbody below 4000 K, where it is undefined.
Spectrum daylight(double kelvin);

// XYZ of a light, scaled to Y = 1.
Xyz xyzOfLight(const Spectrum& light);
// XYZ of a reflectance (or transmittance) under daylight D65 of Y = 1.
Xyz xyzUnderD65(const Spectrum& s);

// Linear sRGB of XYZ. Colours outside the gamut have negative channels.
Vec3 srgbOf(const Xyz& xyz);
// Converts light from another colour space; its white keeps its colour.
Vec3 srgbOfLight(const Vec3& rgb, ColorSpace from);
// Converts a reflectance from another colour space; its white becomes white (Bradford).
Vec3 srgbOfReflectance(const Vec3& rgb, ColorSpace from);
// Rows of the matrix that white-balances linear sRGB from `kelvin` to sRGB's white (Bradford).
std::array<Vec3, 3> whiteBalance(double kelvin);

// Clamps negative channels and keeps the luminance, if that is positive.
Vec3 intoGamut(Vec3 light);

// The complex index of refraction of a metal for red, green and blue. eta is the colour of its
// spectrum under D65. k gives the reflectance at normal incidence the colour that the spectral
// reflectance has under D65.
struct MetalRgb {
  Vec3 eta, k;
};
MetalRgb metalRgb(const Spectrum& eta, const Spectrum& k);
// Reflectance at normal incidence from vacuum.
double metalReflectance(double eta, double k);

// Spectra that pbrt knows by name.
std::optional<Spectrum> namedSpectrum(const std::string& name);  // metal-Au-eta, glass-BK7
std::optional<Xyz> namedIlluminant(const std::string& name);     // stdillum-D65, Y = 1

}  // namespace bnvpl::pbrt
