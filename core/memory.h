// Refuses work that cannot fit into memory before it begins.
#pragma once

#include <cstdint>
#include <string>

#include "core/errors.h"

namespace bnvpl {

// Bytes that this process can still allocate: the minimum of the machine's available memory, the
// rest of its control group's limit (v1 or v2), and the rest of `ulimit -v`.
uint64_t availableMemory();

// Bytes of this process in memory, now and at most so far. getrusage() would tell the peak of the
// program that started it where that was larger.
uint64_t residentMemory();
uint64_t peakMemory();

// Bytes left under the limits of a process's control groups; the page cache counts as free. `root`:
// their hierarchy, /sys/fs/cgroup. `groups`: the groups of a process, as /proc/self/cgroup names
// them.
uint64_t groupsLeave(const fs::path& root, const fs::path& groups);

// Throws MemoryError "WHAT needs about 60 GiB of memory, 21 GiB are available; CURE" if `bytes`
// exceed availableMemory(). The estimate may be rough but must not exceed the actual use, so that
// no work is refused that would have fitted.
void requireMemory(double bytes, const std::string& what, const std::string& cure);

}  // namespace bnvpl
