#include "tools/eliminate/greedy.h"

#include <algorithm>
#include <atomic>
#include <numeric>

#include "core/parallel.h"

namespace bnvpl {
namespace {

constexpr uint32_t kNone = UINT32_MAX;

class Rounds {
 public:
  Rounds(const ConflictGraph& graph, std::span<const uint32_t> row)
      : graph_(graph),
        row_(row),
        weight_(graph.weights()),
        alive_(graph.size(), 1),
        blocker_(graph.size(), kNone),
        blocks_((graph.size() + kBlock - 1) / kBlock) {
    for (size_t b = 0; b < blocks_.size(); ++b) {
      const size_t first = b * kBlock;
      blocks_[b].open.resize(std::min(kBlock, graph.size() - first));
      std::iota(blocks_[b].open.begin(), blocks_[b].open.end(), static_cast<uint32_t>(first));
    }
  }

  // One round: decides on the weights as they are, then changes them.
  bool advance() {
    parallelFor(blocks_.size(), 1, [&](size_t b) { pickMaxima(blocks_[b]); });
    parallelFor(blocks_.size(), 1, [&](size_t b) { removePicked(blocks_[b]); });
    std::erase_if(blocks_, [](const Block& block) { return block.open.empty(); });
    return !blocks_.empty();
  }

  std::vector<uint64_t> takeWeights() { return std::move(weight_); }

 private:
  static constexpr size_t kBlock = 2048;
  struct Block {
    std::vector<uint32_t> open;    // alive and with a weight
    std::vector<uint32_t> picked;  // to be removed in this round
  };

  bool outweighs(uint32_t a, uint32_t b) const {
    return weight_[a] != weight_[b] ? weight_[a] > weight_[b] : row_[a] > row_[b];
  }

  void pickMaxima(Block& block) {
    block.picked.clear();
    size_t kept = 0;
    for (const uint32_t i : block.open) {
      if (weight_[i] == 0 || !alive_[i]) continue;
      if (isMaximum(i)) {
        block.picked.push_back(i);
      } else {
        block.open[kept++] = i;
      }
    }
    block.open.resize(kept);
  }

  // Remembers the heaviest neighbour: as long as it is heavier, nothing else needs to be looked at.
  bool isMaximum(uint32_t i) {
    const uint32_t known = blocker_[i];
    if (known != kNone && alive_[known] && outweighs(known, i)) return false;
    uint32_t heaviest = i;
    graph_.visitNeighbours(i, [&](uint32_t j) {
      if (alive_[j] && outweighs(j, heaviest)) heaviest = j;
      return true;
    });
    blocker_[i] = heaviest;
    return heaviest == i;
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
};

}  // namespace

std::vector<uint64_t> weightsAtRemoval(const ConflictGraph& graph, std::span<const uint32_t> row) {
  Rounds rounds(graph, row);
  while (rounds.advance()) {
  }
  return rounds.takeWeights();
}

}  // namespace bnvpl
