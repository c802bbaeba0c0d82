// Spectra, and the linear sRGB that pbrt's film makes of them.
//
// pbrt renders wavelengths and integrates them with the CIE 1931 observer; its colour space then
// makes linear RGB of XYZ, without adaptation. For one surface under one light the results here
// are the same. What light does on several coloured surfaces one after the other differs, as
// always between rendering in RGB and in wavelengths. docs/scenes.md says it for users.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/errors.h"
#include "core/vec3.h"
#include "scene/read/pbrt/params.h"

namespace bnvpl::pbrt {

using Xyz = std::array<double, 3>;

// Linear between samples, and constant beyond them.
struct Spectrum {
  std::vector<double> nm;  // rising
  std::vector<double> value;
  double at(double wavelength) const;
};

// Samples "nm value nm value ..." of a parameter or file. None where they are no spectrum.
std::optional<Spectrum> spectrumOf(const std::vector<double>& pairs);
// A text of such pairs; '#' begins a comment. Throws InputError.
Spectrum readSpd(const fs::path& file);

Spectrum blackbody(double kelvin);
// CIE daylight of a correlated colour temperature; below 4000 K, where there is none, a blackbody.
Spectrum daylight(double kelvin);

// Of light, scaled to Y = 1.
Xyz xyzOfLight(const Spectrum& light);
// Of what a spectrum leaves of daylight D65, whose Y is 1.
Xyz xyzUnderD65(const Spectrum& s);

// Linear sRGB of XYZ. Colours outside of the gamut have negative channels.
Vec3 srgbOf(const Xyz& xyz);
// An RGB triple of another colour space, as light: its white keeps its colour.
Vec3 srgbOfLight(const Vec3& rgb, ColorSpace from);
// The same as a reflectance: its white becomes white (Bradford).
Vec3 srgbOfReflectance(const Vec3& rgb, ColorSpace from);
// What a white balance to `kelvin` does to linear sRGB: XYZ adapted by Bradford's matrix to sRGB's
// white. Rows.
std::array<Vec3, 3> whiteBalance(double kelvin);

// Without negative channels, at the same luminance where it has one.
Vec3 intoGamut(Vec3 light);

// The complex index of refraction of a metal for red, green and blue: eta is the spectrum's colour
// under D65, and k such that the reflectance at normal incidence has the colour that the
// spectra give under D65.
struct MetalRgb {
  Vec3 eta, k;
};
MetalRgb metalRgb(const Spectrum& eta, const Spectrum& k);
// At normal incidence, against vacuum.
double metalReflectance(double eta, double k);

// What pbrt knows by name.
std::optional<Spectrum> namedSpectrum(const std::string& name);  // metal-Au-eta, glass-BK7
std::optional<Xyz> namedIlluminant(const std::string& name);     // stdillum-D65, Y = 1

}  // namespace bnvpl::pbrt
