// Greedy elimination in parallel, with the result of the sequential one.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tools/eliminate/conflict_graph.h"

namespace bnvpl {

// The order in which the sequential greedy removes nodes: heaviest first; of equal weights, the
// higher row first. Row numbers differ.
struct RemovalKey {
  uint64_t weight;
  uint32_t row;
  friend bool operator<(const RemovalKey& a, const RemovalKey& b) {
    return a.weight != b.weight ? a.weight < b.weight : a.row < b.row;
  }
};

// Runs "remove the heaviest node and take its pair weights from its neighbours" until at most
// `keep` nodes are left, or no pair is, and returns each node's weight: when it was removed, or at
// the end. Sorted by RemovalKey, last first, this is the sequence of removals, followed by the
// nodes that were left in any order: the `keep` smallest keys are what the sequential algorithm
// keeps.
//
// Why: weights only fall. A node that outweighs all its neighbours goes before any of them,
// whatever happens elsewhere, and with the weight that it has now. So all such local maxima can go
// at once, and as every removal lowers the others, the sequential keys only fall, so that sorting
// restores the order. A falling threshold holds back the light nodes: all removals above it are
// made before any below, so that the work can end at the first threshold with few enough nodes
// left.
std::vector<uint64_t> weightsAtRemoval(const ConflictGraph& graph, std::span<const uint32_t> row,
                                       size_t keep);

}  // namespace bnvpl
