#include "tools/eliminate/greedy.h"

#include <algorithm>
#include <atomic>

#include "core/parallel.h"

namespace bnvpl {
namespace {

constexpr uint32_t kNone = UINT32_MAX;
// Each threshold as a share of the greatest weight that is left. Nearer to 1: more passes; farther:
// nodes are looked at again and again before it is their turn. Measured best of 0.1 to 0.95.
constexpr double kThresholdStep = 0.3;

class Elimination {
 public:
  Elimination(const ConflictGraph& graph, std::span<const uint32_t> row)
      : graph_(graph),
        row_(row),
        weight_(graph.weights()),
        alive_(graph.size(), 1),
        blocker_(graph.size(), kNone),
        blocks_((graph.size() + kBlock - 1) / kBlock),
        left_(graph.size()) {
    parallelFor(blocks_.size(), 1, [&](size_t b) {
      blocks_[b].begin = static_cast<uint32_t>(b * kBlock);
      blocks_[b].end = static_cast<uint32_t>(std::min(graph.size(), (b + 1) * kBlock));
      activate(blocks_[b], UINT64_MAX);
    });
  }

  size_t left() const { return left_; }

  // Makes every removal at or above the next threshold. False when no pair is left.
  bool advance() {
    uint64_t greatest = 0;
    for (const Block& block : blocks_) greatest = std::max(greatest, block.greatestBelow);
    if (greatest == 0) return false;
    const double threshold = static_cast<double>(greatest) * kThresholdStep;
    threshold_ = std::max<uint64_t>(1, static_cast<uint64_t>(threshold));

    busy_.clear();
    for (Block& block : blocks_) {
      if (block.greatestBelow >= threshold_) busy_.push_back(&block);
    }
    forBusy([&](Block& block) { activate(block, threshold_); });
    dropIdle();
    while (!busy_.empty()) {
      forBusy([&](Block& block) { pickMaxima(block); });
      forBusy([&](Block& block) { removePicked(block); });
      for (const Block* block : busy_) left_ -= block->picked.size();
      dropIdle();
    }
    return true;
  }

  std::vector<uint64_t> takeWeights() { return std::move(weight_); }

 private:
  static constexpr size_t kBlock = 1024;
  struct Block {
    uint32_t begin = 0, end = 0;   // of its nodes
    uint64_t greatestBelow = 0;    // no weight below the threshold is above this
    std::vector<uint32_t> active;  // alive and at or above the threshold
    std::vector<uint32_t> picked;  // to be removed in this round
  };

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
      if (!alive_[i]) continue;
      if (weight_[i] >= threshold) {
        block.active.push_back(i);
      } else {
        block.greatestBelow = std::max(block.greatestBelow, weight_[i]);
      }
    }
  }

  // Decides on the weights as they are; nothing but the block's lists is changed.
  void pickMaxima(Block& block) {
    block.picked.clear();
    size_t kept = 0;
    for (const uint32_t i : block.active) {
      if (weight_[i] < threshold_) {
        block.greatestBelow = std::max(block.greatestBelow, weight_[i]);
      } else if (isMaximum(i)) {
        block.picked.push_back(i);
      } else {
        block.active[kept++] = i;
      }
    }
    block.active.resize(kept);
  }

  bool outweighs(uint32_t a, uint32_t b) const {
    return weight_[a] != weight_[b] ? weight_[a] > weight_[b] : row_[a] > row_[b];
  }

  // Remembers a heavier neighbour: as long as it is one, nothing else needs to be looked at.
  bool isMaximum(uint32_t i) {
    const uint32_t known = blocker_[i];
    if (known != kNone && alive_[known] && outweighs(known, i)) return false;
    return graph_.visitNeighbours(i, [&](uint32_t j) {
      if (!alive_[j] || !outweighs(j, i)) return true;
      blocker_[i] = j;
      return false;
    });
  }

  // No two picked nodes are neighbours, so a removed node's own weight stays what it was.
  void removePicked(Block& block) {
    for (const uint32_t i : block.picked) {
      alive_[i] = 0;
      graph_.visitNeighbours(i, [&](uint32_t j) {
        if (alive_[j]) {
          std::atomic_ref(weight_[j]).fetch_sub(graph_.pairWeight(i, j), std::memory_order_relaxed);
        }
        return true;
      });
    }
  }

  const ConflictGraph& graph_;
  std::span<const uint32_t> row_;
  std::vector<uint64_t> weight_;
  std::vector<uint8_t> alive_;
  std::vector<uint32_t> blocker_;
  std::vector<Block> blocks_;
  std::vector<Block*> busy_;
  size_t left_;
  uint64_t threshold_ = UINT64_MAX;
};

}  // namespace

std::vector<uint64_t> weightsAtRemoval(const ConflictGraph& graph, std::span<const uint32_t> row,
                                       size_t keep) {
  Elimination elimination(graph, row);
  while (elimination.left() > keep && elimination.advance()) {
  }
  return elimination.takeWeights();
}

}  // namespace bnvpl
