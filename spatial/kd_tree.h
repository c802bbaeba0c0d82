// Exact nearest neighbours over points of any density: FLANN's single kd-tree. The only FLANN
// include is in kd_tree.cpp.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "core/vec3.h"
#include "spatial/neighbour.h"

namespace bnvpl {

class KdTree {
 public:
  explicit KdTree(std::span<const Vec3> points);
  ~KdTree();
  KdTree(const KdTree&) = delete;
  KdTree& operator=(const KdTree&) = delete;

  // Replaces `found` by the `count` points nearest to `centre` (all of them where there are fewer),
  // ordered by (distance, index); equal distances at the end go to the lower indices.
  void nearest(Vec3 centre, size_t count, std::vector<Neighbour>& found) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace bnvpl
