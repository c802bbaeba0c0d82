// Greedy elimination in parallel, with the result of the sequential one.
#pragma once

#include <cstdint>
#include <vector>

#include "core/progress.h"
#include "tools/eliminate/elimination/conflict_graph.h"

namespace bnvpl {

// The rows of the `keep` nodes that are left after "remove the heaviest node and take its pair
// weights from its neighbours" has run until no more than that many are left; of equal weights the
// higher row goes first. In no particular order. Uses up the graph.
//
// Why it can be done in parallel: weights only fall. A node that outweighs all its neighbours goes
// before any of them, whatever happens elsewhere, and with the weight that it has now. So all such
// local maxima can go at once. A falling threshold holds back the light nodes: all removals above
// it are made before any below, so that only those of the last threshold can be too many, and of
// them the ones that the sequential algorithm would have made last are taken back: those of the
// smallest (weight, row), as its sequence of weights never rises.
// `progress` counts the nodes removed.
std::vector<uint32_t> eliminateHeaviest(ConflictGraph& graph, size_t keep,
                                        const ProgressFn& progress = {});

}  // namespace bnvpl
