#pragma once

#include <chrono>

namespace bnvpl {

// Seconds since some moment in the past; never runs backwards.
inline double nowS() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace bnvpl
