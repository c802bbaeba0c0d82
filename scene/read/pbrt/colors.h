// Parameters that are colours -> linear sRGB, as docs/scenes.md says.
#pragma once

#include <optional>

#include "scene/read/pbrt/description.h"
#include "scene/read/pbrt/spectrum.h"

namespace bnvpl::pbrt {

class Colors {
 public:
  // `folder` is the scene's; spectra that are read are added to `files`.
  Colors(const fs::path& folder, Notes& notes, std::vector<fs::path>& files)
      : folder_(folder), notes_(notes), files_(files) {}

  // Radiance or intensity before `scale`: of an rgb itself, of a blackbody or spectrum its colour
  // at luminance 1. Without the parameter the white of the colour space. Not negative.
  Vec3 light(const Params& params, const std::string& name, ColorSpace space) const;
  // From 0 to 1.
  Vec3 reflectance(const Param& p) const;
  // Of any size, not negative.
  Vec3 unbounded(const Param& p) const;
  // An index of refraction that is one number: that at 587.6 nm of a spectrum.
  double ior(const Params& params, const std::string& name, double otherwise) const;
  // "eta" and "k"; of names and files by their spectra, else as triples. Copper where both lack.
  MetalRgb metal(const Params& params, const std::string& eta, const std::string& k) const;

 private:
  Spectrum spectrum(const Param& p) const;
  bool isSpectrum(const Param* p) const { return p && p->type == ParamType::Spectrum; }

  const fs::path& folder_;
  Notes& notes_;
  std::vector<fs::path>& files_;
};

// An rgb's three numbers.
Vec3 rgbOf(const Param& p);

}  // namespace bnvpl::pbrt
