#include "tools/eliminate/elimination/greedy.h"

#include <algorithm>

#include "core/parallel.h"

namespace bnvpl {
namespace {

// Each threshold is this share of the greatest weight left. A larger share makes more passes, a
// smaller one tests nodes more often before they are removed. 0.7 was the fastest of 0.1 to 0.9.
constexpr double kThresholdStep = 0.7;
// Removed nodes slow scans down, so the graph is compacted when less than this share of its nodes
// is left.
constexpr double kCompactBelow = 0.7;

struct Removal {
  uint64_t weight;
  uint32_t row;
  friend bool operator<(const Removal& a, const Removal& b) {
    return a.weight != b.weight ? a.weight < b.weight : a.row < b.row;
  }
};

class Elimination {
 public:
  explicit Elimination(ConflictGraph& graph) : graph_(graph), left_(graph.size()) { makeBlocks(); }

  size_t left() const { return left_; }
  // Removals of the last threshold.
  std::vector<Removal> takeRemovals() { return std::move(removals_); }

  // Makes every removal at or above the next threshold. False when no pair is left.
  bool advance() {
    uint64_t greatest = 0;
    for (const Block& block : blocks_) greatest = std::max(greatest, block.greatestBelow);
    if (greatest == 0) return false;
    const double threshold = static_cast<double>(greatest) * kThresholdStep;
    threshold_ = std::max<uint64_t>(1, static_cast<uint64_t>(threshold));
    removals_.clear();
    if (static_cast<double>(left_) < kCompactBelow * static_cast<double>(graph_.size())) {
      graph_.compact();
      makeBlocks();
    }
    busy_.clear();
    for (Block& block : blocks_) {
      if (block.greatestBelow >= threshold_) busy_.push_back(&block);
    }
    forBusy([&](Block& block) { activate(block, threshold_); });
    dropIdle();
    while (!busy_.empty()) {
      forBusy([&](Block& block) { pickMaxima(block); });
      forBusy([&](const Block& block) {
        for (const uint32_t i : block.picked) graph_.release(i);
      });
      for (const Block* block : busy_) {
        left_ -= block->picked.size();
        for (const uint32_t i : block->picked) {
          removals_.push_back({graph_.weight(i), graph_.row(i)});
          graph_.markRemoved(i);
        }
      }
      dropIdle();
    }
    return true;
  }

 private:
  static constexpr size_t kBlock = 1024;
  struct Block {
    uint32_t begin = 0, end = 0;   // range of its nodes
    uint64_t greatestBelow = 0;    // upper bound of its weights below the threshold
    std::vector<uint32_t> active;  // nodes left at or above the threshold
    std::vector<uint32_t> picked;  // nodes to be removed in this round
  };

  void makeBlocks() {
    blocker_.assign(graph_.size(), ConflictGraph::kNone);
    blocks_.assign((graph_.size() + kBlock - 1) / kBlock, {});
    parallelFor(blocks_.size(), 1, [&](size_t b) {
      blocks_[b].begin = static_cast<uint32_t>(b * kBlock);
      blocks_[b].end = static_cast<uint32_t>(std::min(graph_.size(), (b + 1) * kBlock));
      activate(blocks_[b], UINT64_MAX);
    });
  }

  template <typename Work>
  void forBusy(const Work& work) {
    parallelFor(busy_.size(), 1, [&](size_t b) { work(*busy_[b]); });
  }
  void dropIdle() {
    std::erase_if(busy_, [](const Block* block) { return block->active.empty(); });
  }

  void activate(Block& block, uint64_t threshold) {
    block.active.clear();
    block.greatestBelow = 0;
    for (uint32_t i = block.begin; i < block.end; ++i) {
      if (graph_.removed(i)) continue;
      if (graph_.weight(i) >= threshold) {
        block.active.push_back(i);
      } else {
        block.greatestBelow = std::max(block.greatestBelow, graph_.weight(i));
      }
    }
  }

  // Picks the local maxima of the current weights. Writes only to the block and the blockers of its
  // nodes.
  void pickMaxima(Block& block) {
    block.picked.clear();
    size_t kept = 0;
    for (const uint32_t i : block.active) {
      if (graph_.weight(i) < threshold_) {
        block.greatestBelow = std::max(block.greatestBelow, graph_.weight(i));
      } else if (isMaximum(i)) {
        block.picked.push_back(i);
      } else {
        block.active[kept++] = i;
      }
    }
    block.active.resize(kept);
  }

  // Remembers a heavier neighbour and searches again only when it is lighter. Removed nodes have
  // weight 0.
  bool isMaximum(uint32_t i) {
    uint32_t& blocker = blocker_[i];
    if (blocker != ConflictGraph::kNone && graph_.outweighs(blocker, i)) return false;
    blocker = graph_.heavierNeighbour(i);
    return blocker == ConflictGraph::kNone;
  }

  ConflictGraph& graph_;
  std::vector<uint32_t> blocker_;
  std::vector<Block> blocks_;
  std::vector<Block*> busy_;
  std::vector<Removal> removals_;
  size_t left_;
  uint64_t threshold_ = UINT64_MAX;
};

}  // namespace

std::vector<uint32_t> eliminateHeaviest(ConflictGraph& graph, size_t keep,
                                        const ProgressFn& progress) {
  Elimination elimination(graph);
  size_t told = graph.size();  // nodes left when progress was last reported
  while (elimination.left() > keep && elimination.advance()) {
    const size_t left = std::max(keep, elimination.left());
    if (progress) progress(told - left);
    told = left;
  }
  if (progress) progress(told - keep);
  std::vector<Removal> last = elimination.takeRemovals();
  std::vector<uint32_t> rows;
  std::vector<Removal> left;
  for (uint32_t i = 0; i < graph.size(); ++i) {
    if (!graph.removed(i)) left.push_back({graph.weight(i), graph.row(i)});
  }
  // If too many were removed, the last removals of smallest (weight, row) are undone. If too few
  // were, no pairs are left, and the nodes of smallest (weight, row) are kept.
  std::vector<Removal>& part = left.size() < keep ? last : left;
  const size_t fromPart = left.size() < keep ? keep - left.size() : keep;
  if (fromPart < part.size()) {
    std::nth_element(part.begin(), part.begin() + static_cast<ptrdiff_t>(fromPart), part.end());
    part.resize(fromPart);
  }
  if (left.size() < keep) {
    for (const Removal& r : last) rows.push_back(r.row);
  }
  for (const Removal& r : left) rows.push_back(r.row);
  return rows;
}

}  // namespace bnvpl
