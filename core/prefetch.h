// Prefetches memory that will be read soon, so that cache misses of independent queries overlap.
#pragma once

namespace bnvpl {

inline void prefetch(const void* at) { __builtin_prefetch(at); }

}  // namespace bnvpl
