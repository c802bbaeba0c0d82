// Disks on surfaces and those near to each on the same surface: what they know is averaged, as one
// alone knows little.
#pragma once

#include <vector>

#include "spatial/compatible_surface.h"
#include "spatial/reach_grid.h"

namespace bnvpl {

class NearSurfaces {
 public:
  // Points, their unit normals and their radii (> 0, finite), world units. Borrows them. `reach`,
  // in radii: within which others count; 2.5 has about five, 5 about twenty.
  NearSurfaces(std::span<const Vec3> points, std::span<const Vec3> normals,
               std::span<const float> radii, float reach)
      : points_(points),
        normals_(normals),
        radii_(radii),
        reach_(reach),
        grid_(points, normals, scaled(radii, reach)) {}

  // Calls fn(k) for disk i itself and those near to it, in a fixed order.
  template <typename Fn>
  void forEach(size_t i, const Fn& fn) const {
    ReachGrid::forEachReaching(grid_.lookUp(points_[i]), [&](const ReachGrid::Disk& d) {
      if (compatibleSurfaces(points_[i], normals_[i], d.centre, d.normal,
                             kPlaneFactor * reach_ * radii_[i], kMinDot))
        fn(d.index);
    });
  }

 private:
  static constexpr float kMinDot = 0.9f;  // normals differ by at most 25 degrees

  static std::vector<float> scaled(std::span<const float> radii, float factor) {
    std::vector<float> scaled(radii.begin(), radii.end());
    for (float& r : scaled) r *= factor;
    return scaled;
  }

  std::span<const Vec3> points_, normals_;
  std::span<const float> radii_;
  float reach_;
  ReachGrid grid_;
};

}  // namespace bnvpl
