// The surface area that each point of a cloud represents.
#pragma once

#include <span>
#include <vector>

#include "core/progress.h"
#include "core/vec3.h"
#include "spatial/kd_tree.h"

namespace bnvpl {

// Estimated surface area of each point, world units squared: pi d^2 / k, with d the distance to the
// k-th nearest other point on a compatible surface (spatial/compatible_surface.h; the plane
// tolerance is kPlaneFactor times the distance to the k-th nearest point of any orientation). The
// sum over all points estimates the area that they cover. If fewer than k of the 3 k nearest points
// qualify, d and k are those of the furthest that does; if none does, those of the furthest of all.
// Distances are at least 1e-6 of the bounding box's diagonal, so that coincident points get a small
// positive share. If all points coincide, each share is their squared distance from the origin, or
// 1 at the origin. `rows` selects points, with one result each; if empty, all points are selected
// in order. `progress` counts them.
std::vector<float> representedAreas(std::span<const Vec3> position, std::span<const Vec3> normal,
                                    unsigned k, const KdTree& tree,
                                    std::span<const uint32_t> rows = {},
                                    const ProgressFn& progress = {});
std::vector<float> representedAreas(std::span<const Vec3> position, std::span<const Vec3> normal,
                                    unsigned k, const ProgressFn& progress = {});

// The default k. Clamps are in units of radii that follow from it, and so are comparable between
// methods.
inline constexpr unsigned kAreaNeighbours = 20;

// Radii of VPLs that were not spread by elimination: each represents its share of the surface.
struct RepresentedRadii {
  std::vector<float> radius;  // share = 2 sqrt(3) radius^2, for disks in their densest packing
  double area = 0.0;          // sum of the shares
  double rMax = 0.0;          // radius of equally many equal disks
};
RepresentedRadii representedRadii(std::span<const Vec3> position, std::span<const Vec3> normal);

}  // namespace bnvpl
