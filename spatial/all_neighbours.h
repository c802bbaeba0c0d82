// Exact nearest neighbours of every point of a set, faster than by KdTree: a query begins in the
// point's own leaf, and whole leaves are compared at once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/vec3.h"
#include "spatial/neighbour.h"

namespace bnvpl {

// A balanced kd-tree with the points of each leaf side by side. Its nodes form a complete binary
// tree: the children of node n are 2n + 1 and 2n + 2. Built in parallel; any number of threads
// gives the same tree.
class AllNeighbours {
 public:
  explicit AllNeighbours(std::span<const Vec3> points);

  // The state of consecutive queries. The neighbours of the last point bound the distance to those
  // of the next, which is much faster where consecutive points are near each other and `count`
  // stays.
  struct Query {
    static constexpr uint32_t kNone = UINT32_MAX;
    uint32_t lastPoint = kNone;
    size_t lastCount = 0;
    float lastDistance = 0.0f;   // to the furthest of the lastCount points found
    std::vector<uint64_t> keys;  // squared distance, as bits, and index: they compare as Neighbour
  };

  // Replaces `found` by the `count` points nearest to this point, itself included, or by all if
  // there are fewer, ordered by (distance, index): the result of KdTree::nearest() at its position.
  void nearest(uint32_t point, size_t count, Query& query, std::vector<Neighbour>& found) const;

 private:
  struct Box {
    Vec3 low, high;
    // Never above the squared distance of a point in the box, as both round alike.
    float distanceSquared(Vec3 p) const {
      const Vec3 d = max(max(low - p, p - high), Vec3(0.0f));
      return d.x * d.x + d.y * d.y + d.z * d.z;
    }
  };
  struct Search;

  Vec3 positionOf(uint32_t point) const {
    const uint32_t place = place_[point];
    return {x_[place], y_[place], z_[place]};
  }
  float boundOf(Vec3 centre, size_t count, const Query& query) const;
  void searchFrom(uint32_t leaf, Search& search) const;
  bool isLeaf(uint32_t node) const { return node >= firstLeaf_; }
  uint32_t beginOf(uint32_t leaf) const { return leafBegin_[leaf - firstLeaf_]; }
  uint32_t endOf(uint32_t leaf) const { return leafBegin_[leaf - firstLeaf_ + 1]; }
  void split(std::span<uint32_t> order, uint32_t first, uint32_t node,
             std::span<const Vec3> points);
  void visit(uint32_t node, Search& search) const;
  void visitLeaf(uint32_t leaf, Search& search) const;

  uint32_t firstLeaf_ = 0;
  std::vector<Box> boxes_;              // one for each node
  std::vector<uint32_t> leafBegin_;     // first place of each leaf, and the number of points
  std::vector<float> x_, y_, z_;        // coordinates by place
  std::vector<uint32_t> index_;         // index of the point at a place
  std::vector<uint32_t> place_, leaf_;  // place and leaf of each point
};

}  // namespace bnvpl
