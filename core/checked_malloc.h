// malloc for C libraries that do not check its result: throws std::bad_alloc instead of returning
// null. Memory that the library holds is leaked, because the tool ends anyway.
#pragma once

#include <cstdlib>
#include <new>

namespace bnvpl {

inline void* mallocOrThrow(std::size_t bytes) {
  if (void* memory = std::malloc(bytes)) return memory;
  throw std::bad_alloc();
}

}  // namespace bnvpl
