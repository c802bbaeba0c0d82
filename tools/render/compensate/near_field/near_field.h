// What the VPLs leave out of the light from one surface point to another: the part of 1/d^2 that
// the clamp removes, and all light from points that no VPL stands for. Sampled rays bring exactly
// that back (Kollig & Keller 2006, with the VPLs' own bound and gaps).
#pragma once

#include <atomic>
#include <optional>
#include <vector>

#include "tools/render/compensate/compensate.h"
#include "transport/coverage.h"
#include "transport/virtual_light_kinds.h"

namespace bnvpl {

class NearField {
 public:
  // Borrows the table and the scene. `clamp` and `kind` as for makeVplLights().
  NearField(const VplTable& lit, const RayScene& rays, float clamp, LightKind kind = {});

  // `near`: what coverage() finds at the point.
  Missing missing(const SurfacePoint& seen, float distance, const ReachGrid::Lookup& near,
                  Rng& rng) const;
  const Coverage& coverage() const { return coverage_; }

 private:
  // Of Missing: mean of the surface that the VPL speaks for; empty where that is not known.
  std::optional<Vec3> scatteredBy(uint32_t vpl) const;

  const VplTable& lit_;
  const RayScene& rays_;
  Coverage coverage_;
  LightKind kind_;
  std::vector<float> clampRadius_;  // of each VPL, world units
  // Of that surface, world units squared; measured when it is first asked for, as an image of few
  // pixels meets few of many VPLs.
  mutable std::vector<std::atomic<float>> area_;
  bool gaps_;  // whether a point without a VPL is a gap: not for VPLs from the lights
};

}  // namespace bnvpl
