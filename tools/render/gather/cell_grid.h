// A grid of cubic cells over a box, and items sorted by the cells that hold them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "core/vec3.h"

namespace bnvpl {

// Cells [low, high], both included, along each axis.
struct CellBox {
  std::array<uint32_t, 3> low{}, high{};
};

class CellGrid {
 public:
  // Cells of the given side; larger ones where there would be more than `kMaxCells`.
  CellGrid(const Bounds& box, float side) : lower_(box.lower), side_(side) {
    const Vec3 extent = box.extent();
    const auto along = [&](size_t a) {
      return std::max(1.0, std::ceil(double{extent[a] / side_}));
    };
    while (along(0) * along(1) * along(2) > kMaxCells) side_ *= 1.25f;
    for (size_t a = 0; a < 3; ++a) size_[a] = static_cast<uint32_t>(along(a));
  }
  size_t count() const { return size_t{size_[0]} * size_[1] * size_[2]; }
  float side() const { return side_; }
  size_t index(uint32_t x, uint32_t y, uint32_t z) const {
    return (size_t{z} * size_[1] + y) * size_[0] + x;
  }
  // The cell that holds a point, or the nearest to it.
  size_t at(Vec3 p) const { return index(along(p, 0), along(p, 1), along(p, 2)); }
  Bounds bounds(size_t cell) const {
    const size_t x = cell % size_[0], y = cell / size_[0] % size_[1],
                 z = cell / size_[0] / size_[1];
    const Vec3 low = lower_ + side_ * Vec3(float(x), float(y), float(z));
    return {low, low + Vec3(side_)};
  }
  // Cells that a sphere may meet.
  CellBox within(Vec3 centre, float radius) const {
    CellBox box;
    for (size_t a = 0; a < 3; ++a) {
      box.low[a] = along(centre - Vec3(radius), a);
      box.high[a] = along(centre + Vec3(radius), a);
    }
    return box;
  }

 private:
  static constexpr double kMaxCells = 0x1p24;
  uint32_t along(Vec3 p, size_t axis) const {
    const float cells = (p[axis] - lower_[axis]) / side_;
    const auto last = static_cast<float>(size_[axis] - 1);
    return static_cast<uint32_t>(std::clamp(cells, 0.0f, last));
  }

  Vec3 lower_;
  float side_;
  std::array<uint32_t, 3> size_{1, 1, 1};
};

// Points, listed by cells.
class CellPoints {
 public:
  CellPoints(CellGrid grid, std::span<const Vec3> points) : grid_(grid) {
    begin_.assign(grid_.count() + 1, 0);
    for (const Vec3 p : points) ++begin_[grid_.at(p) + 1];
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    std::vector<uint32_t> next(begin_.begin(), begin_.end() - 1);
    items_.resize(points.size());
    for (uint32_t i = 0; i < points.size(); ++i) items_[next[grid_.at(points[i])]++] = i;
  }
  // Calls fn(point) for all points of the cells that a sphere may meet, in a fixed order.
  template <typename Fn>
  void forWithin(Vec3 centre, float radius, const Fn& fn) const {
    const CellBox box = grid_.within(centre, radius);
    for (uint32_t z = box.low[2]; z <= box.high[2]; ++z) {
      for (uint32_t y = box.low[1]; y <= box.high[1]; ++y) {
        // The cells of a row follow each other.
        const uint32_t begin = begin_[grid_.index(box.low[0], y, z)],
                       end = begin_[grid_.index(box.high[0], y, z) + 1];
        for (uint32_t k = begin; k < end; ++k) fn(items_[k]);
      }
    }
  }

 private:
  CellGrid grid_;
  std::vector<uint32_t> begin_, items_;
};

}  // namespace bnvpl
