// Indirect light varies within a pixel where the surface in sight changes, or its texture: there
// the noise of a pixel is that of which of its few samples saw what. What the VPLs know of the
// light at a surface is a control variate for it: it is cheap enough to be asked along many more
// camera rays.
#pragma once

#include "tools/render/irradiance_field.h"
#include "tools/render/tile/pixel_rays.h"

namespace bnvpl {

class PixelControl {
 public:
  // Borrows rays and lights.
  PixelControl(const RayScene& rays, const LightSet& lights, const FilmPoints& film,
               const VplTable& lit);

  // Corrects the indirect light of the tile's samples, which saw `paths`, by
  // beta (mean over further rays of what the VPLs say - what they say for the sample), whose
  // expectation is 0. beta: how far the light follows what the VPLs say, in the other pixels of the
  // tile.
  void apply(const TileSamples& tile, std::span<const SpecularPath> paths) const;

 private:
  static constexpr uint32_t kDrawRays = 13u << 27;
  Vec3 said(const SpecularPath& path) const;
  std::vector<float> saidOf(const FilmPoints& film) const;

  const Scene& scene_;
  IrradianceField field_;
  PixelRays pixels_;
};

}  // namespace bnvpl
