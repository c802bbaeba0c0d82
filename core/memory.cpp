#include "core/memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <limits>
#include <optional>
#include <vector>

namespace bnvpl {
namespace {

constexpr uint64_t kUnlimited = std::numeric_limits<uint64_t>::max();

std::optional<uint64_t> numberIn(const fs::path& file) {  // empty for "max", or without the file
  std::ifstream in(file);
  uint64_t value = 0;
  if (in >> value) return value;
  return {};
}

// Reads a line such as "MemAvailable:   21510308 kB".
uint64_t machineLeaves() {
  std::ifstream in("/proc/meminfo");
  uint64_t kib = 0;
  for (std::string line; std::getline(in, line);) {
    if (std::sscanf(line.c_str(), "MemAvailable: %lu kB", &kib) == 1) return kib * 1024;
  }
  return kUnlimited;
}

uint64_t groupLeaves(const fs::path& limit, const fs::path& used) {
  const std::optional<uint64_t> most = numberIn(limit), now = numberIn(used);
  if (!most || !now) return kUnlimited;
  return *most > *now ? *most - *now : 0;
}

// A line of /proc/self/cgroup is "0::/path" (version 2) or "4:memory:/path" (version 1). In a
// container the path may be invisible; its own group then appears as the root.
uint64_t groupsLeave() {
  const fs::path root = "/sys/fs/cgroup";
  std::vector<std::string> v2{""}, v1{""};
  std::ifstream in("/proc/self/cgroup");
  for (std::string line; std::getline(in, line);) {
    const size_t path = line.rfind(':') + 1;
    if (line.starts_with("0::")) v2.push_back(line.substr(path));
    if (line.find(":memory:") != std::string::npos) v1.push_back(line.substr(path));
  }
  uint64_t least = kUnlimited;
  for (const std::string& path : v2) {
    const fs::path folder = root.string() + path;
    least = std::min(least, groupLeaves(folder / "memory.max", folder / "memory.current"));
  }
  for (const std::string& path : v1) {
    const fs::path folder = (root / "memory").string() + path;
    least = std::min(
        least, groupLeaves(folder / "memory.limit_in_bytes", folder / "memory.usage_in_bytes"));
  }
  return least;
}

uint64_t addressSpaceLeaves() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kUnlimited;
  const uint64_t pages = numberIn("/proc/self/statm").value_or(0);  // size of the address space
  const uint64_t used = pages * static_cast<uint64_t>(::sysconf(_SC_PAGESIZE));
  return limit.rlim_cur > used ? limit.rlim_cur - used : 0;
}

std::string inGiB(double bytes) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g GiB", bytes / 0x1p30);
  return text;
}

}  // namespace

uint64_t availableMemory() {
  return std::min({machineLeaves(), groupsLeave(), addressSpaceLeaves()});
}

void requireMemory(double bytes, const std::string& what, const std::string& cure) {
  const auto available = static_cast<double>(availableMemory());
  if (bytes <= available) return;
  throw MemoryError(what + " needs about " + inGiB(bytes) + " of memory, " + inGiB(available) +
                    " are available; " + cure);
}

}  // namespace bnvpl
