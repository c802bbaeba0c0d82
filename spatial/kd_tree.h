// Exact nearest neighbours of points of any density, by FLANN's single kd-tree. Only kd_tree.cpp
// includes FLANN.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "core/vec3.h"
#include "spatial/neighbour.h"

namespace bnvpl {

// Immutable and thread-safe.
class KdTree {
 public:
  // Borrows the points.
  explicit KdTree(std::span<const Vec3> points);
  ~KdTree();
  KdTree(const KdTree&) = delete;
  KdTree& operator=(const KdTree&) = delete;

  // Replaces `found` by the `count` points nearest to `centre`, or by all if there are fewer,
  // ordered by (distance, index).
  void nearest(Vec3 centre, size_t count, std::vector<Neighbour>& found) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace bnvpl
