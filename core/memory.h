// Work that cannot fit into memory is refused before it begins.
#pragma once

#include <cstdint>
#include <string>

#include "core/errors.h"

namespace bnvpl {

// Bytes that this process can still take: the least of what the machine has available, what its
// control group leaves (v2, or v1), and `ulimit -v`.
uint64_t availableMemory();

// Throws MemoryError "WHAT needs about 60 GiB of memory, 21 GiB are available; CURE" when it does.
// The estimate may be rough, but must not be above what is taken in truth: nobody should be refused
// what would have worked.
void requireMemory(double bytes, const std::string& what, const std::string& cure);

}  // namespace bnvpl
