// Distributions over the strata of the lights for each part of the surface, learned by shadow rays
// from the VPLs that represent it. Used for vertices that the camera does not see directly.
#pragma once

#include <vector>

#include "core/progress.h"
#include "spatial/region_grid.h"
#include "transport/direct_light/direct_light.h"

namespace bnvpl {

// Thread-safe and immutable once made.
class SpatialLightSampler {
 public:
  // Takes points on surfaces, their unit normals, and the radius (> 0, world units) around each for
  // which it is representative. `key` seeds the random numbers.
  SpatialLightSampler(const Accelerator& accel, const LightSet& lights,
                      std::span<const Vec3> points, std::span<const Vec3> normals,
                      std::span<const float> radii, uint64_t key, const ProgressFn& progress);

  // The distribution at a position; the mean of all where no point is near. Empty, with `all` null,
  // if there are fewer than two strata or no points.
  LearnedStrata at(Vec3 position, Vec3 normal) const;

 private:
  LightStrata strata_;
  RegionGrid regions_;
  std::vector<uint32_t> distributionOf_;     // group of each point
  std::vector<StrataValues> distributions_;  // distribution of each group, as running sums
  StrataValues everywhere_;
};

}  // namespace bnvpl
