// What the VPLs leave out of the light from one surface point to another: the part of 1/d^2 that
// the clamp removes, and all light from points that no VPL stands for. Sampled rays bring exactly
// that back (Kollig & Keller 2006, with the VPLs' own bound and gaps).
#pragma once

#include <atomic>
#include <optional>
#include <vector>

#include "formats/vpl_table.h"
#include "transport/coverage.h"

namespace bnvpl {

class NearField {
 public:
  // What VPLs do not bring from a point that a ray from a receiver has found.
  struct Missing {
    float share = 0.0f;  // of the light from there, 0..1
    // Radiance that leaves there of light that came by way of other surfaces, W/(m2 sr); empty: has
    // to be found out, as straight light always has, whose edges a VPL does not know.
    std::optional<Vec3> scattered;
  };

  // Borrows the table and the scene. `clamp` as for makeVplLights().
  NearField(const VplTable& lit, const RayScene& rays, float clamp);

  // For a point that a ray has found from `distance`, world units.
  Missing missing(const SurfacePoint& seen, float distance, Rng& rng) const {
    return missing(seen, distance, coverage_.lookUp(seen.position), rng);
  }
  // The same, looked up in coverage() before.
  Missing missing(const SurfacePoint& seen, float distance, const ReachGrid::Lookup& near,
                  Rng& rng) const;
  const Coverage& coverage() const { return coverage_; }

 private:
  // Of Missing: mean of the surface that the VPL speaks for; empty where that is not known.
  std::optional<Vec3> scatteredBy(uint32_t vpl) const;

  const VplTable& lit_;
  const RayScene& rays_;
  Coverage coverage_;
  std::vector<float> clampRadius_;  // of each VPL, world units
  // Of that surface, world units squared; measured when it is first asked for, as an image of few
  // pixels meets few of many VPLs.
  mutable std::vector<std::atomic<float>> area_;
  bool gaps_;  // whether a point without a VPL is a gap: not for VPLs from the lights
};

}  // namespace bnvpl
