// Points within a radius, for queries of about one size: OpenVDB's point index grid. The only
// OpenVDB include is in point_grid.cpp.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/vec3.h"
#include "spatial/neighbour.h"

namespace bnvpl {

class PointGrid {
 public:
  // `cellSize` (world units) is best at the usual query radius. It is raised where some point is
  // more than a million cells from the world's origin.
  PointGrid(std::span<const Vec3> points, float cellSize);
  ~PointGrid();
  PointGrid(const PointGrid&) = delete;
  PointGrid& operator=(const PointGrid&) = delete;

  // Replaces `found` by every point at most `radius` away, in no particular but a repeatable order.
  void withinRadius(Vec3 centre, float radius, std::vector<Neighbour>& found) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace bnvpl
