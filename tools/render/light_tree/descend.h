// Random descent of the light tree.
#pragma once

#include <algorithm>
#include <optional>

#include "tools/render/light_tree/light_tree.h"

namespace bnvpl {

// Draws a VPL of a node by one random number in [0, 1). `leftShare(left, right)` is the probability
// of the left child, or empty if neither child may light the receiver; then nothing is drawn.
template <typename LeftShare>
std::optional<VplSample> descend(const LightTree& tree, uint32_t node, double u,
                                 const LeftShare& leftShare) {
  float probability = 1.0f;
  while (!tree.nodes[node].leaf()) {
    const LightNode& n = tree.nodes[node];
    const std::optional<float> left = leftShare(tree.nodes[n.left], tree.nodes[n.right]);
    if (!left) return {};
    const bool goLeft = u < double{*left};
    const float share = goLeft ? *left : 1.0f - *left;
    // The number is used again. Its 53 bits leave enough for the last levels.
    u = std::min((goLeft ? u : u - double{*left}) / double{share}, 0x1.fffffffffffffp-1);
    probability *= share;
    node = goLeft ? n.left : n.right;
  }
  return VplSample{tree.nodes[node].representative, probability};
}

}  // namespace bnvpl
