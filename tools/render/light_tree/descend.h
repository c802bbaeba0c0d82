// Random descent of the light tree.
#pragma once

#include <algorithm>
#include <optional>

#include "tools/render/light_tree/light_tree.h"

namespace bnvpl {

struct Descent {
  uint32_t vpl;
  float probability;
};

// Draws a VPL of a node by one random number in [0, 1). `leftShare(left, right)` is the probability
// of the left child, or empty if neither child may light the receiver; then nothing is drawn.
template <typename LeftShare>
std::optional<Descent> descend(const LightTree& tree, uint32_t node, float u,
                               const LeftShare& leftShare) {
  float probability = 1.0f;
  while (!tree.nodes[node].leaf()) {
    const LightNode& n = tree.nodes[node];
    const std::optional<float> left = leftShare(tree.nodes[n.left], tree.nodes[n.right]);
    if (!left) return {};
    const bool goLeft = u < *left;
    const float share = goLeft ? *left : 1.0f - *left;
    u = std::min((goLeft ? u : u - *left) / share, 0x1.fffffep-1f);  // reuses the random number
    probability *= share;
    node = goLeft ? n.left : n.right;
  }
  return Descent{tree.nodes[node].representative, probability};
}

}  // namespace bnvpl
