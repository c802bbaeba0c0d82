// Which candidates are too near to each other, and how much each pair weighs.
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

// Weight of a pair at `distance` whose radii add up to `reach`: (1 - distance / reach)^alpha, and 0
// from reach on (Yuksel 2015, section 3). Weight limiting: pairs nearer than limit * reach weigh as
// at that distance; 0 turns it off.
struct PairWeight {
  float alpha = 8.0f;
  float limit = 0.0f;

  float operator()(float distance, float reach) const {
    const float x = 1.0f - std::max(distance / reach, limit);
    if (!(x > 0.0f)) return 0.0f;
    if (alpha != 8.0f) return std::pow(x, alpha);
    const float x2 = x * x, x4 = x2 * x2;
    return x4 * x4;
  }
};

// The candidates as nodes. Two are neighbours when they are on a compatible surface (plane
// tolerance kPlaneFactor * (r_i + r_j)) at less than r_i + r_j. A node's weight is the sum of the
// weights of its pairs in fixed point, which is exact in any order: what was added can be
// subtracted again without a remainder, by any thread.
//
// Pairs are not stored: at 40 candidates a VPL they would take half a kilobyte a candidate. They
// are found anew by a scan of neighbouring cells, which costs little more than reading a list
// would.
class ConflictGraph {
 public:
  static constexpr uint32_t kNone = UINT32_MAX;

  // One entry a candidate: position, unit normal, radius > 0, and a number that tells equal weights
  // apart. The vectors are given up so that nothing is in memory twice. `progress` is told of the
  // weights as of preparations.
  ConflictGraph(std::vector<Vec3> position, std::vector<Vec3> normal, std::vector<float> radius,
                std::vector<uint32_t> row, const PairWeight& rule, const ProgressFn& progress = {});

  size_t size() const { return row_.size(); }
  uint32_t row(uint32_t i) const { return row_[i]; }
  uint64_t weight(uint32_t i) const { return weight_[i]; }
  bool removed(uint32_t i) const { return !(radius_[i] == radius_[i]); }

  // Heaviest first; of equal weights, the higher row first.
  bool outweighs(uint32_t a, uint32_t b) const {
    return weight_[a] != weight_[b] ? weight_[a] > weight_[b] : row_[a] > row_[b];
  }
  // Any neighbour that outweighs i, or kNone. i has pairs: its weight is not 0.
  uint32_t heavierNeighbour(uint32_t i) const;

  // Takes the weights of i's pairs from its neighbours. Threads may do this for several nodes at
  // once, if no two are neighbours; then each is marked as removed, while nothing else goes on.
  void release(uint32_t i);
  void markRemoved(uint32_t i);

  // Drops the removed nodes: the others get new numbers.
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
  // In the cells' order, kLanes longer than size(); the radius of the removed is NaN.
  std::vector<float> x_, y_, z_, radius_;
  std::vector<Vec3> normal_;
  std::vector<uint32_t> row_;
  std::vector<uint64_t> weight_;
  PairWeight rule_;
  float scale_;
};

}  // namespace bnvpl
