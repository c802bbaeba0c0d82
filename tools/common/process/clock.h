#pragma once

#include <chrono>

namespace bnvpl {

// Seconds of a monotonic clock with an arbitrary zero.
inline double nowS() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace bnvpl
