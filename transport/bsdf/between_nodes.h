// Interpolation in tables whose nodes are denser near 0: value = t^2, t evenly spaced in [0, 1].
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace bnvpl {

constexpr float nodeSquared(size_t i, size_t count) {
  const float t = static_cast<float>(i) / static_cast<float>(count - 1);
  return t * t;
}

// Linear interpolation between two nodes: index of the lower one, and weight of the upper.
struct BetweenNodes {
  size_t node;
  float share;
};
// The nodes around a value, which is clamped to [0, 1].
template <size_t kCount>
BetweenNodes betweenSquared(float value) {
  static constexpr std::array<float, kCount> kNodes = [] {
    std::array<float, kCount> nodes{};
    for (size_t i = 0; i < kCount; ++i) nodes[i] = nodeSquared(i, kCount);
    return nodes;
  }();
  value = std::clamp(value, 0.0f, 1.0f);
  const auto t = static_cast<size_t>(std::sqrt(value) * static_cast<float>(kCount - 1));
  const size_t node = std::min(kCount - 2, t);
  const float low = kNodes[node], high = kNodes[node + 1];
  return {node, std::clamp((value - low) / (high - low), 0.0f, 1.0f)};
}

}  // namespace bnvpl
