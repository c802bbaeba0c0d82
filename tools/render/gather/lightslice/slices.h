// The points that the camera sees, divided by position and normal.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "transport/rays.h"

namespace bnvpl::methods::gather::lightslice {

class Slices {
 public:
  Slices() = default;
  // At most `count`, each with one point at random that stands for it. Points whose triangle is
  // kNone are left out.
  Slices(std::span<const SurfacePoint> points, size_t count, uint64_t key);

  std::span<const SurfacePoint> representatives() const { return representatives_; }
  // Of any point of the scene, by the planes that the slices were divided with.
  uint32_t sliceOf(const SurfacePoint& point) const;
  // The slice itself and the `others` whose representatives are nearest.
  std::vector<uint32_t> nearest(size_t slice, size_t others) const;

 private:
  struct Node {
    uint32_t axis = 0;  // of six: position, scaled normal
    float middle = 0.0f;
    uint32_t below = 0, above = 0;  // nodes; both 0: a leaf
    uint32_t slice = 0;
  };
  float coordinate(const SurfacePoint& p, uint32_t axis) const {
    return axis < 3 ? p.position[axis] : normalScale_ * p.ns[axis - 3];
  }
  std::vector<Node> nodes_;
  std::vector<SurfacePoint> representatives_;
  float normalScale_ = 1.0f;
};

}  // namespace bnvpl::methods::gather::lightslice
