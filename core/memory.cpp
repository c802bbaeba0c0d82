#include "core/memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <limits>
#include <optional>
#include <string_view>

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

// The names of a group's files in one version of control groups.
struct GroupFiles {
  const char *limit, *used, *inactiveFile, *activeFile;  // the last two are lines of memory.stat
};
constexpr GroupFiles kVersion2{"memory.max", "memory.current", "inactive_file", "active_file"},
    kVersion1{"memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file",
              "total_active_file"};

// Bytes of files that the group has in memory, which the system takes back when it needs them.
uint64_t cachedFiles(const fs::path& group, const GroupFiles& files) {
  std::ifstream in(group / "memory.stat");
  uint64_t sum = 0, value = 0;
  for (std::string name; in >> name >> value;)
    if (name == files.inactiveFile || name == files.activeFile) sum += value;
  return sum;
}

uint64_t groupLeaves(const fs::path& group, const GroupFiles& files) {
  const std::optional<uint64_t> most = numberIn(group / files.limit),
                                now = numberIn(group / files.used);
  if (!most || !now) return kUnlimited;
  const uint64_t used = *now - std::min(*now, cachedFiles(group, files));
  return *most > used ? *most - used : 0;
}

// The minimum over a group and those that it is in, up to the root of the hierarchy.
uint64_t branchLeaves(const fs::path& root, const std::string& path, const GroupFiles& files) {
  uint64_t least = groupLeaves(root, files);
  for (fs::path group = fs::path(path).relative_path(); !group.empty(); group = group.parent_path())
    least = std::min(least, groupLeaves(root / group, files));
  return least;
}

uint64_t addressSpaceLeaves() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kUnlimited;
  const uint64_t pages = numberIn("/proc/self/statm").value_or(0);  // size of the address space
  const uint64_t used = pages * static_cast<uint64_t>(::sysconf(_SC_PAGESIZE));
  return limit.rlim_cur > used ? limit.rlim_cur - used : 0;
}

uint64_t ofStatus(const char* format) {  // a line such as "VmHWM:     12345 kB"
  std::ifstream in("/proc/self/status");
  unsigned long kib = 0;
  for (std::string line; std::getline(in, line);)
    if (std::sscanf(line.c_str(), format, &kib) == 1) break;
  return uint64_t{kib} * 1024;
}

std::string inGiB(double bytes) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g GiB", bytes / 0x1p30);
  return text;
}

}  // namespace

uint64_t residentMemory() { return ofStatus("VmRSS: %lu kB"); }
uint64_t peakMemory() { return ofStatus("VmHWM: %lu kB"); }

// A line of `groups` is "0::/path" (version 2) or "4:memory:/path" (version 1). In a container the
// path may be invisible; its own group then appears as the root.
uint64_t groupsLeave(const fs::path& root, const fs::path& groups) {
  constexpr std::string_view kTwo = "0::", kOne = ":memory:";
  uint64_t least = std::min(groupLeaves(root, kVersion2), groupLeaves(root / "memory", kVersion1));
  std::ifstream in(groups);
  for (std::string line; std::getline(in, line);) {
    const size_t one = line.find(kOne);
    if (line.starts_with(kTwo))
      least = std::min(least, branchLeaves(root, line.substr(kTwo.size()), kVersion2));
    else if (one != std::string::npos)
      least =
          std::min(least, branchLeaves(root / "memory", line.substr(one + kOne.size()), kVersion1));
  }
  return least;
}

uint64_t availableMemory() {
  return std::min(
      {machineLeaves(), groupsLeave("/sys/fs/cgroup", "/proc/self/cgroup"), addressSpaceLeaves()});
}

void requireMemory(double bytes, const std::string& what, const std::string& cure) {
  const auto available = static_cast<double>(availableMemory());
  if (bytes <= available) return;
  throw MemoryError(what + " needs about " + inGiB(bytes) + " of memory, " + inGiB(available) +
                    " are available; " + cure);
}

}  // namespace bnvpl
