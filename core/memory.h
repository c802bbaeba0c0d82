// Refuses work that cannot fit into memory before it begins.
#pragma once

#include <cstdint>
#include <string>

#include "core/errors.h"

namespace bnvpl {

// Bytes that this process can still allocate: the minimum of the machine's available memory, the
// rest of its control group's limit (v1 or v2), and the rest of `ulimit -v`.
uint64_t availableMemory();

// Throws MemoryError "WHAT needs about 60 GiB of memory, 21 GiB are available; CURE" if `bytes`
// exceed availableMemory(). The estimate may be rough but must not exceed the actual use, so that
// no work is refused that would have fitted.
void requireMemory(double bytes, const std::string& what, const std::string& cure);

}  // namespace bnvpl
