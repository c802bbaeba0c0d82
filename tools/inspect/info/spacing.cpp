#include "tools/inspect/info/spacing.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.h"
#include "spatial/compatible_surface.h"
#include "spatial/kd_tree.h"

namespace bnvpl {
namespace {

constexpr float kNone = std::numeric_limits<float>::infinity();

struct RowSpacing {
  float distance = kNone;  // to the nearest row on a compatible surface
  float own = kNone;       // min distance / (r_i + r_j) over the compatible rows that were visited
};

RowSpacing measureRow(const VplTable& table, const KdTree& tree, uint32_t row,
                      std::vector<Neighbour>& found) {
  const bool radii = !table.radius.empty();
  RowSpacing result;
  // Most rows have a compatible row among the nearest eight; at corners and thin parts it takes
  // more.
  for (size_t count = 8; count <= kSpacingNeighbours; count *= 4) {
    tree.nearest(table.position[row], count + 1, found);  // includes the row itself
    for (const Neighbour& n : found) {
      if (n.index == row) continue;
      const float distance = std::sqrt(n.distanceSquared);
      const float reach = radii ? table.radius[row] + table.radius[n.index] : distance;
      if (!compatibleSurfaces(table.position[row], table.normal[row], table.position[n.index],
                              table.normal[n.index], kPlaneFactor * reach)) {
        continue;
      }
      result.distance = std::min(result.distance, distance);
      if (radii) result.own = std::min(result.own, distance / reach);
    }
    if (result.distance < kNone || found.size() >= table.size()) break;
  }
  return result;
}

}  // namespace

Spacing measureSpacing(const VplTable& table) {
  Spacing spacing;
  if (table.size() < 2) {
    spacing.alone = table.size();
    return spacing;
  }
  const KdTree tree(table.position);
  std::vector<RowSpacing> rows(table.size());
  parallelRanges(table.size(), 256, [&](size_t begin, size_t end) {
    std::vector<Neighbour> found;
    for (size_t i = begin; i < end; ++i) rows[i] = measureRow(table, tree, uint32_t(i), found);
  });

  double minDistance = INFINITY, minOwn = INFINITY;
  for (const RowSpacing& row : rows) {
    if (row.distance == kNone) {
      ++spacing.alone;
      continue;
    }
    ++spacing.measured;
    minDistance = std::min(minDistance, double{row.distance});
    spacing.meanDistance += double{row.distance};
    minOwn = std::min(minOwn, double{row.own});
    spacing.meanOwn += double{row.own};
  }
  if (spacing.measured == 0) return spacing;
  const double count = double(spacing.measured);
  spacing.minDistance = minDistance;
  spacing.meanDistance /= count;
  if (table.rMax > 0.0) {
    spacing.minRelative = minDistance / (2.0 * table.rMax);
    spacing.meanRelative = spacing.meanDistance / (2.0 * table.rMax);
  }
  spacing.minOwn = table.radius.empty() ? 0.0 : minOwn;
  spacing.meanOwn = table.radius.empty() ? 0.0 : spacing.meanOwn / count;
  return spacing;
}

}  // namespace bnvpl
