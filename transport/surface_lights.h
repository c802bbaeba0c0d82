// Which parts of the lights each part of the surface sees, far from the camera: learned by shadow
// rays from the VPLs that stand for it.
#pragma once

#include <vector>

#include "core/progress.h"
#include "spatial/region_grid.h"
#include "transport/direct_light.h"

namespace bnvpl {

// Thread-safe and immutable once made.
class SurfaceLights {
 public:
  // Points on surfaces, their unit normals, and how far each speaks for its surroundings (> 0,
  // world units). Borrows the lights until it is made; `key`: of its random numbers.
  SurfaceLights(const RayScene& rays, const LightSet& lights, std::span<const Vec3> points,
                std::span<const Vec3> normals, std::span<const float> radii, uint64_t key,
                const ProgressFn& progress);

  // Around a point; what all points see where none of them speaks for it. Empty, without `all`,
  // where there is nothing to choose: fewer than two strata, or no points.
  LearnedStrata at(Vec3 position, Vec3 normal) const;

 private:
  LightStrata strata_;
  RegionGrid regions_;
  std::vector<uint32_t> groupOf_;     // of each point
  std::vector<StrataValues> groups_;  // running sums
  StrataValues everywhere_;
};

}  // namespace bnvpl
