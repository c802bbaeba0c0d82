// The light between two surface points that VPLs leave out: the part of 1/d^2 that the clamp
// removes, and all light from points that no VPL covers. Sampled rays add exactly this light
// (Kollig & Keller 2006).
#pragma once

#include <atomic>
#include <optional>
#include <vector>

#include "tools/render/compensate/compensate.h"
#include "transport/coverage.h"
#include "transport/virtual_light/kinds.h"

namespace bnvpl {

class NearField {
 public:
  // Borrows the table and the scene. `clamp`, `kind` and `groups`: those of makeVplLights().
  NearField(const VplTable& lit, const Accelerator& accel, float clamp, VplKind kind = {},
            const VplGroups& groups = {});

  // `coverLookup`: the result of coverage().lookUp() for the point.
  Uncovered uncovered(const SurfacePoint& point, float distance,
                      const ReachGrid::Lookup& coverLookup, Rng& rng) const;
  const Coverage& coverage() const { return coverage_; }

 private:
  // Radiance over flux, the mean over the surface that the VPL covers; empty if its area is
  // unknown.
  std::optional<float> perFluxOf(uint32_t vpl) const;

  const VplTable& lit_;
  Coverage coverage_;
  VplKind kind_;
  std::vector<float> clampRadius_;  // one per VPL, world units
  uint32_t groups_;
  std::vector<Vec3> multiBounceFlux_;  // by light group, VPL after VPL
  // Area of the surface that each VPL covers, world units squared. It is measured on first use, as
  // an image of few pixels needs only few of many VPLs.
  mutable std::vector<std::atomic<float>> area_;
  bool covers_;  // whether VPLs cover areas; those of vpl-place --method light do not
};

}  // namespace bnvpl
