#include "spatial/point_grid.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/PointIndexGrid.h>

#include <algorithm>

namespace bnvpl {
namespace {

using Grid = openvdb::tools::PointIndexGrid;
using Leaf = Grid::TreeType::LeafNodeType;
// Unregistered, so that one can be made for each query without touching shared state.
using Accessor = openvdb::tree::ValueAccessor<const Grid::TreeType, /*IsSafe=*/false>;
using openvdb::Coord;
using openvdb::Vec3d;

// The interface that OpenVDB partitions through.
struct PointList {
  using PosType = Vec3d;
  std::span<const Vec3> points;
  size_t size() const { return points.size(); }
  void getPos(size_t n, PosType& xyz) const { xyz = Vec3d(points[n].x, points[n].y, points[n].z); }
};

// Cell numbers are 32-bit and start at the world's origin.
float safeCellSize(std::span<const Vec3> points, float wanted) {
  Bounds bounds;
  for (const Vec3 p : points) bounds.extend(p);
  const float furthest = points.empty() ? 0.0f : maxComponent(max(bounds.upper, -bounds.lower));
  return std::max({wanted, furthest * 1e-6f, 1e-30f});
}

}  // namespace

struct PointGrid::Impl {
  std::span<const Vec3> points;
  double cellsPerUnit = 1.0;
  Grid::Ptr grid;

  Coord cell(Vec3 p) const {
    return Coord::floor(Vec3d(p.x, p.y, p.z) * cellsPerUnit + Vec3d(0.5));
  }
};

PointGrid::PointGrid(std::span<const Vec3> points, float cellSize)
    : impl_(std::make_unique<Impl>()) {
  const double size = safeCellSize(points, cellSize);
  impl_->points = points;
  impl_->cellsPerUnit = 1.0 / size;
  impl_->grid = openvdb::tools::createPointIndexGrid<Grid>(PointList{points}, size);
}
PointGrid::~PointGrid() = default;

void PointGrid::withinRadius(Vec3 centre, float radius, std::vector<Neighbour>& found) const {
  found.clear();
  const float radiusSquared = radius * radius;
  // Wider by what the rounding of `centre - point` and of the cell borders may amount to.
  const Vec3 reach(radius * (1.0f + 1e-5f) + maxComponent(max(centre, -centre)) * 1e-6f);
  const Coord lower = impl_->cell(centre - reach), upper = impl_->cell(centre + reach);
  const Accessor accessor(impl_->grid->tree());
  constexpr int kLeafMask = ~static_cast<int>(Leaf::DIM - 1);
  for (int x = lower.x(); x <= upper.x(); ++x) {
    for (int y = lower.y(); y <= upper.y(); ++y) {
      // A leaf orders its points by cell, z fastest, and a cell's value is where its points end:
      // cells along z are one run of indices for each leaf.
      for (int z = lower.z(), zEnd; z <= upper.z(); z = zEnd + 1) {
        zEnd = std::min(upper.z(), (z & kLeafMask) + static_cast<int>(Leaf::DIM) - 1);
        const Leaf* leaf = accessor.probeConstLeaf(Coord(x, y, z));
        if (!leaf) continue;
        const openvdb::Index first = Leaf::coordToOffset(Coord(x, y, z));
        const openvdb::Index last = first + static_cast<openvdb::Index>(zEnd - z);
        const openvdb::PointIndex32* const indices = leaf->indices().data();
        const auto* begin = indices + (first == 0 ? 0u : uint32_t{leaf->buffer()[first - 1]});
        const auto* const end = indices + uint32_t{leaf->buffer()[last]};
        for (; begin != end; ++begin) {
          const float d2 = lengthSquared(impl_->points[*begin] - centre);
          if (d2 <= radiusSquared) found.push_back({d2, static_cast<uint32_t>(*begin)});
        }
      }
    }
  }
}

}  // namespace bnvpl
