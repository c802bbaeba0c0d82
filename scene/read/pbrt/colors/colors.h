// Converts colour parameters to linear sRGB, as docs/scenes.md describes.
#pragma once

#include <optional>

#include "scene/read/pbrt/colors/spectrum.h"
#include "scene/read/pbrt/syntax/description.h"

namespace bnvpl::pbrt {

class Colors {
 public:
  // `folder` is the scene's folder. Files of spectra that are read are added to `files`.
  Colors(const fs::path& folder, Notes& notes, std::vector<fs::path>& files)
      : folder_(folder), notes_(notes), files_(files) {}

  // Radiance or intensity before `scale`: an rgb as it is, a blackbody or spectrum as its colour at
  // luminance 1; without the parameter, the white of the colour space. Never negative.
  Vec3 light(const Params& params, const std::string& name, ColorSpace space) const;
  // A reflectance, clamped to 0..1.
  Vec3 reflectance(const Param& p) const;
  // A colour of any magnitude, never negative.
  Vec3 unbounded(const Param& p) const;
  // A scalar index of refraction; a spectrum is evaluated at 587.6 nm.
  double ior(const Params& params, const std::string& name, double otherwise) const;
  // The same of a coat, which is at least 1.
  double coatIor(const Params& params, const std::string& name, double otherwise) const;
  // The index eta + i k. Two spectra are converted together, triples are used as they are. Each is
  // that of copper by default.
  MetalRgb metal(const Params& params, const std::string& eta, const std::string& k) const;

 private:
  // The numbers of an rgb, or a float three times; those that are clamped to 0..most are noted.
  Vec3 checked(const Param& p, double most = kMax) const;
  Spectrum spectrum(const Param& p) const;
  bool isSpectrum(const Param* p) const { return p && p->type == ParamType::Spectrum; }

  const fs::path& folder_;
  Notes& notes_;
  std::vector<fs::path>& files_;
};

// The three numbers of an rgb.
Vec3 rgbOf(const Param& p);
// Notes a number of the parameter that is below 0 or above `most`, as which it counts.
void noteClamped(const Param& p, double most, Notes& notes);

}  // namespace bnvpl::pbrt
