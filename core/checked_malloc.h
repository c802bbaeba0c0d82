// malloc for C-like libraries that do not look at what it returns: throws std::bad_alloc instead of
// returning null. What the library held until then is lost; the tool is about to end anyway.
#pragma once

#include <cstdlib>
#include <new>

namespace bnvpl {

inline void* mallocOrThrow(std::size_t bytes) {
  if (void* memory = std::malloc(bytes)) return memory;
  throw std::bad_alloc();
}

inline void* reallocOrThrow(void* old, std::size_t bytes) {
  if (void* memory = std::realloc(old, bytes)) return memory;
  throw std::bad_alloc();
}

}  // namespace bnvpl
