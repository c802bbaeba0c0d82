// What the VPLs leave out of the light from one surface point to another: the part of 1/d^2 that
// the clamp removes, and all light from points that no VPL stands for. A sampled ray brings exactly
// that back (Kollig & Keller 2006, with the VPLs' own bound and gaps).
#pragma once

#include "formats/vpl_table.h"
#include "scene/coverage.h"

namespace bnvpl {

class NearField {
 public:
  // Borrows the table and the scene. `clamp` as for makeVplLights().
  NearField(const VplTable& lit, const RayScene& rays, float clamp);

  // Share of the light from `seen` that VPLs do not bring to a receiver at `distance`: 0..1.
  float missingShare(const SurfacePoint& seen, float distance, Rng& rng) const;

 private:
  Coverage coverage_;
  std::vector<float> clampRadius_;  // of each VPL, world units
  bool gaps_;  // whether a point without a VPL is a gap: not for VPLs from the lights
};

}  // namespace bnvpl
