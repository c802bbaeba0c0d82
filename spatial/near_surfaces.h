// Finds, for each of many disks on surfaces, the nearby disks on the same surface, over which
// learned quantities are averaged.
#pragma once

#include <vector>

#include "spatial/compatible_surface.h"
#include "spatial/reach_grid.h"

namespace bnvpl {

class NearSurfaces {
 public:
  // Takes points, their unit normals and their radii (> 0, finite), world units, and borrows them.
  // Disks reach `reach` radii: 2.5 finds about five disks, 5 about twenty.
  NearSurfaces(std::span<const Vec3> points, std::span<const Vec3> normals,
               std::span<const float> radii, float reach)
      : points_(points),
        normals_(normals),
        radii_(radii),
        reach_(reach),
        grid_(points, normals, scaled(radii, reach)) {}

  // Calls fn(k) for disk i itself and the disks near it, in a fixed order.
  template <typename Fn>
  void forEach(size_t i, const Fn& fn) const {
    ReachGrid::forEachReaching(grid_.lookUp(points_[i]), [&](const ReachGrid::Disk& d) {
      if (compatibleSurfaces(points_[i], normals_[i], d.centre, d.normal,
                             kPlaneFactor * reach_ * radii_[i], kMinDot))
        fn(d.index);
    });
  }

 private:
  static constexpr float kMinDot = 0.9f;  // normals differ by at most 26 degrees

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
