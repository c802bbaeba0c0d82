// The cell of a grid along an axis.
#pragma once

#include <algorithm>
#include <cstdint>

namespace bnvpl {

// Floor of a coordinate in cells, clamped to +-1e15. std::floor is a function call without SSE4.1.
inline int64_t cellAlong(float cells) {
  const float bounded = std::clamp(cells, -1e15f, 1e15f);
  const auto whole = static_cast<int64_t>(bounded);
  return whole - (bounded < static_cast<float>(whole) ? 1 : 0);
}

}  // namespace bnvpl
