// Parallel greedy elimination with the result of the sequential algorithm.
#pragma once

#include <cstdint>
#include <vector>

#include "core/progress.h"
#include "tools/eliminate/elimination/conflict_graph.h"

namespace bnvpl {

// Repeats "remove the heaviest node and subtract its pair weights from its neighbours" until `keep`
// nodes are left; of equal weights, the higher row goes first. Returns the rows of these nodes, in
// no particular order. Consumes the graph. `progress` counts the nodes removed.
//
// The removals run in parallel because weights only fall. A node that outweighs all of its
// neighbours goes before any of them, with its current weight, whatever happens elsewhere. So all
// such local maxima are removed at once. A falling threshold orders the rounds: all removals above
// it are made before any below, so only the last threshold can remove too many. The removals that
// the sequential algorithm would have made last are then undone. Its sequence of weights never
// rises, so they are those of smallest (weight, row).
std::vector<uint32_t> eliminateHeaviest(ConflictGraph& graph, size_t keep,
                                        const ProgressFn& progress = {});

}  // namespace bnvpl
