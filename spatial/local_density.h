// How much surface each point of a cloud stands for.
#pragma once

#include <span>
#include <vector>

#include "core/progress.h"
#include "core/vec3.h"
#include "spatial/kd_tree.h"

namespace bnvpl {

// Estimated surface area per point, world units squared: pi d^2 / k, with d the distance to the
// k-th nearest other point on a compatible surface (spatial/compatible_surface.h; the plane
// tolerance is kPlaneFactor times the distance to the k-th nearest point of any orientation). Its
// sum over all points estimates the area that they cover. Among the 3 k nearest, fewer than k may
// qualify: then the furthest that does and their number stand in; when none does, the furthest of
// all and the number of all. Distances are at least 1e-6 of the bounding box's diagonal, so that
// coincident points get a small positive share. When every point is at one place, which has no
// scale but its distance from the origin, each share is the square of that, or 1 at the origin
// itself. `rows` picks whose shares are wanted, one result each; empty = all points in order.
// `progress` counts them.
std::vector<float> surfaceShares(std::span<const Vec3> position, std::span<const Vec3> normal,
                                 unsigned k, const KdTree& tree,
                                 std::span<const uint32_t> rows = {},
                                 const ProgressFn& progress = {});
std::vector<float> surfaceShares(std::span<const Vec3> position, std::span<const Vec3> normal,
                                 unsigned k, const ProgressFn& progress = {});

// k, unless somebody asks for another. Clamps are in units of the radii that come of it, and so
// compare between methods.
inline constexpr unsigned kShareNeighbours = 20;

// Radii of VPLs that nobody has spread: each stands for its share of the surface.
struct ShareRadii {
  std::vector<float> radius;  // share = 2 sqrt(3) radius^2, as of disks in their densest packing
  double area = 0.0;          // the sum of the shares
  double rMax = 0.0;          // the radius of as many equal disks
};
ShareRadii shareRadii(std::span<const Vec3> position, std::span<const Vec3> normal);

}  // namespace bnvpl
