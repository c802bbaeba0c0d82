// How a stage tells its caller how far it is, without knowing about terminals.
#pragma once

#include <cstdint>
#include <functional>

namespace bnvpl {

// Called with the units of work done since the last call, from any thread. May be empty.
using ProgressFn = std::function<void(uint64_t)>;

}  // namespace bnvpl
