// Graph of the candidates that are too near to each other, with weights of its pairs.
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/progress.h"
#include "core/vec3.h"
#include "spatial/cell_lists.h"

namespace bnvpl {

// Weight of a pair at `distance` whose radii add up to `maxDistance`, Yuksel's 2 r_max: (1 -
// distance / maxDistance)^alpha, and 0 from there on (Yuksel 2015, section 3). Weight limiting
// gives pairs nearer than limit * maxDistance the weight of that distance; a limit of 0 turns it
// off.
struct PairWeight {
  float alpha = 8.0f;
  float limit = 0.0f;

  float operator()(float distance, float maxDistance) const {
    const float x = 1.0f - std::max(distance / maxDistance, limit);
    if (!(x > 0.0f)) return 0.0f;
    if (alpha != 8.0f) return std::pow(x, alpha);
    const float x2 = x * x, x4 = x2 * x2;
    return x4 * x4;
  }
};

// Nodes are candidates. Two are neighbours if they are less than r_i + r_j apart and on compatible
// surfaces (plane tolerance kPlaneFactor * (r_i + r_j)). A node's weight is the sum of the weights
// of its pairs. The sum is kept in fixed point: it is exact in any order, so any thread can
// subtract a weight again without a remainder.
//
// Pairs are not stored: with 40 candidates per VPL they would take half a kilobyte per candidate. A
// scan of neighbouring cells finds them, which takes little longer than reading a list.
class ConflictGraph {
 public:
  static constexpr uint32_t kNone = UINT32_MAX;

  // Each vector has one entry per candidate: position, unit normal, radius > 0, and row, which
  // breaks ties of weights. The vectors are passed by value to be consumed, so that nothing is in
  // memory twice. The sums of weights are reported to `progress` as preparation.
  ConflictGraph(std::vector<Vec3> position, std::vector<Vec3> normal, std::vector<float> radius,
                std::vector<uint32_t> row, const PairWeight& rule, const ProgressFn& progress = {});

  size_t size() const { return row_.size(); }
  uint32_t row(uint32_t i) const { return row_[i]; }
  uint64_t weight(uint32_t i) const { return weight_[i]; }
  bool removed(uint32_t i) const { return !(radius_[i] == radius_[i]); }

  // Order of removal: the heavier node goes first; of equal weights, the higher row.
  bool outweighs(uint32_t a, uint32_t b) const {
    return weight_[a] != weight_[b] ? weight_[a] > weight_[b] : row_[a] > row_[b];
  }
  // Any neighbour that outweighs i, or kNone. The weight of i must not be 0.
  uint32_t heavierNeighbour(uint32_t i) const;

  // release() subtracts the weights of i's pairs from its neighbours. Threads may release several
  // nodes at once if no two of them are neighbours. markRemoved() then completes the removal of
  // each node, while no other thread uses the graph.
  void release(uint32_t i);
  void markRemoved(uint32_t i);

  // Drops the removed nodes. The others get new indices.
  void compact();

 private:
  struct Near {
    float distanceSquared;
    uint32_t index;
  };
  static constexpr uint32_t kAtOnce = 256;
  static constexpr uint32_t kLanes = 4;

  size_t nearIn(uint32_t i, CellLists::Range range, Near* found) const;
  template <typename Visit>
  void visitNeighbours(uint32_t i, const Visit& visit) const;
  uint64_t pairWeight(uint32_t i, uint32_t j, float distanceSquared) const {
    const float weight = rule_(std::sqrt(distanceSquared), radius_[i] + radius_[j]);
    return static_cast<uint64_t>(weight * scale_);
  }
  bool compatible(uint32_t i, uint32_t j) const;

  CellLists cells_;
  // Nodes in the order of the cells, padded by kLanes. The radius of a removed node is NaN.
  std::vector<float> x_, y_, z_, radius_;
  std::vector<Vec3> normal_;
  std::vector<uint32_t> row_;
  std::vector<uint64_t> weight_;
  PairWeight rule_;
  float scale_;
};

}  // namespace bnvpl
