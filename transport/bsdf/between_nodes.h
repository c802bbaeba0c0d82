// Interpolation in tables whose nodes are denser near 0: value = t^2, t evenly spaced in [0, 1].
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace bnvpl {

inline float nodeSquared(size_t i, size_t count) {
  const float t = static_cast<float>(i) / static_cast<float>(count - 1);
  return t * t;
}

// Linear interpolation between two nodes: index of the lower one, and weight of the upper.
struct BetweenNodes {
  size_t node;
  float share;
};
// The nodes around a value, which is clamped to [0, 1].
inline BetweenNodes betweenSquared(float value, size_t count) {
  value = std::clamp(value, 0.0f, 1.0f);
  const auto t = static_cast<size_t>(std::sqrt(value) * static_cast<float>(count - 1));
  const size_t node = std::min(count - 2, t);
  const float low = nodeSquared(node, count), high = nodeSquared(node + 1, count);
  return {node, std::clamp((value - low) / (high - low), 0.0f, 1.0f)};
}

}  // namespace bnvpl
