// A control variate for indirect light within a pixel. Where several surfaces or a texture share a
// pixel, its few samples are noisy by which of them they happen to see. The lit VPLs predict the
// light at a surface point cheaply, so that the prediction can be averaged over many more camera
// rays.
#pragma once

#include "tools/render/tile/control/irradiance_field.h"
#include "tools/render/tile/control/pixel_rays.h"

namespace bnvpl {

class PixelControlVariate {
 public:
  // Borrows accel and lights.
  PixelControlVariate(const Accelerator& accel, const LightSet& lights, const PixelFilter& filter,
                      const FilmPoints& filmPoints, const VplTable& lit,
                      const VplGroups& groups = {});

  // Adds to the indirect light of each sample, which saw the end of its path,
  //
  //   beta (mean prediction over further rays - prediction for the sample),
  //
  // whose expectation is 0 if beta is independent of the sample. beta, the regression of light on
  // prediction, comes from other pixels of the tile; with --reuse it is not quite independent.
  void apply(const TileSamples& tile, std::span<const SpecularPath> paths) const;

 private:
  Vec3 predicted(const SpecularPath& path) const;
  void addByGroup(const SpecularPath& path, float factor, const LightGroupSink& sink) const;
  std::vector<float> predictedAt(const FilmPoints& filmPoints) const;

  const Scene& scene_;
  IrradianceField field_;
  PixelRays pixels_;
};

}  // namespace bnvpl
