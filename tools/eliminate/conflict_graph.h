// Which candidates are too near to each other, and how much each pair weighs.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/vec3.h"
#include "spatial/kd_tree.h"
#include "spatial/point_grid.h"

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

// Pairs (i, j) on the same sheet of surface (plane tolerance kPlaneFactor * (r_i + r_j)) at less
// than r_i + r_j, with weights in fixed point: sums of them are exact in any order, so what was
// added can be subtracted again without a remainder, by any thread.
class ConflictGraph {
 public:
  // The spans are borrowed. Points should be in an order that keeps neighbours together
  // (mortonOrder). The pairs are stored, 8 bytes each, unless an estimate says that they are more
  // than mostPairs: then they are searched anew whenever they are visited. 0: 2^27, a gibibyte.
  ConflictGraph(std::span<const Vec3> position, std::span<const Vec3> normal,
                std::span<const float> radius, const PairWeight& rule, size_t mostPairs = 0);

  size_t size() const { return position_.size(); }
  size_t pairCount() const { return pairCount_; }  // an estimate when they are not stored
  bool stored() const { return stored_; }

  // Sum of the weights of each node's pairs, in fixed point.
  const std::vector<uint64_t>& weights() const { return weight_; }

  uint64_t pairWeight(uint32_t i, uint32_t j) const {
    const float distance = length(position_[j] - position_[i]);
    return static_cast<uint64_t>(rule_(distance, radius_[i] + radius_[j]) * scale_);
  }

  // Calls visit(j) for each neighbour j of i, in no particular order, until it returns false.
  // Returns whether it never did.
  template <typename Visit>
  bool visitNeighbours(uint32_t i, const Visit& visit) const {
    if (!stored_) {
      const std::span<const uint32_t> all = searchNeighbours(i);
      return std::all_of(all.begin(), all.end(), visit);
    }
    const uint32_t* const found = found_[i / kChunk].data();
    const uint32_t* const foundBy = foundBy_.data();
    return std::all_of(found + (i % kChunk == 0 ? 0 : foundEnd_[i - 1]), found + foundEnd_[i],
                       visit) &&
           std::all_of(foundBy + foundByBegin_[i], foundBy + foundByBegin_[i + 1], visit);
  }

 private:
  static constexpr uint32_t kChunk = 1024;

  bool conflict(uint32_t i, uint32_t j, float distanceSquared) const;
  void search(uint32_t i, float radius, std::vector<Neighbour>& near) const;
  std::span<const uint32_t> searchNeighbours(uint32_t i) const;  // until the thread's next call
  // Calls found(j, weight) for the neighbours of i that have a smaller radius, or an equal one and
  // come later: each pair is found once, and no query needs to reach beyond 2 r_i.
  template <typename Found>
  void findPairs(uint32_t i, std::vector<Neighbour>& near, const Found& found) const;
  size_t estimatePairs() const;
  void sumWeights();
  void storePairs();
  void storePairsOfChunk(uint32_t chunk);
  void transpose();

  std::span<const Vec3> position_, normal_;
  std::span<const float> radius_;
  PairWeight rule_;
  float scale_;
  float largestRadius_ = 0.0f;
  size_t pairCount_ = 0;
  bool stored_ = true;
  std::vector<uint64_t> weight_;
  // Queries of one size are the grid's best case; sizes that differ, the tree's. Gone once all is
  // stored.
  std::unique_ptr<PointGrid> grid_;
  std::unique_ptr<KdTree> tree_;

  // A stored pair is in the list `found` of the end that found it, the one with the larger radius,
  // and in the list `foundBy` of the other.
  std::vector<std::vector<uint32_t>> found_;  // the lists of each chunk of kChunk nodes, joined
  std::vector<uint32_t> foundEnd_;            // within the node's chunk
  std::vector<uint64_t> foundByBegin_;        // size() + 1
  std::vector<uint32_t> foundBy_;
};

}  // namespace bnvpl
