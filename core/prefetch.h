// Asks for memory that will be read soon: misses of many independent queries then overlap.
#pragma once

namespace bnvpl {

inline void prefetch(const void* at) { __builtin_prefetch(at); }

}  // namespace bnvpl
