#include "tools/common/process/pin_functions.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "core/errors.h"

namespace bnvpl {
namespace {

constexpr const char* kVariable = "GLIBC_TUNABLES";
constexpr std::string_view kTunable = "glibc.cpu.hwcaps=";
constexpr std::array<std::string_view, 2> kOff{"-FMA", "-FMA4"};

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  for (size_t begin = 0; begin <= text.size() && !text.empty();) {
    const size_t end = std::min(text.find(separator, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

std::string join(const std::vector<std::string>& parts, char separator) {
  std::string text;
  for (const std::string& part : parts)
    text += (text.empty() ? "" : std::string(1, separator)) + part;
  return text;
}

// Adds kOff to tunables such as "glibc.malloc.check=1:glibc.cpu.hwcaps=-AVX2".
std::string pinned(const std::string& tunables) {
  std::vector<std::string> all = split(tunables, ':');
  // The last of several entries for one tunable takes effect.
  auto hwcaps = std::find_if(all.rbegin(), all.rend(),
                             [](const std::string& t) { return t.starts_with(kTunable); });
  if (hwcaps == all.rend()) {
    all.emplace_back(kTunable);
    hwcaps = all.rbegin();
  }
  std::vector<std::string> names = split(hwcaps->substr(kTunable.size()), ',');
  for (const std::string_view off : kOff) {
    if (std::ranges::find(names, off) == names.end()) names.emplace_back(off);
  }
  *hwcaps = std::string(kTunable) + join(names, ',');
  return join(all, ':');
}

}  // namespace

void pinFunctions(Processor processor, char** argv) {
  if (processor == Processor::This) return;
  const char* const before = std::getenv(kVariable);
  const std::string now = pinned(before ? before : "");
  if (before && now == before) return;
  ::setenv(kVariable, now.c_str(), 1);
  std::error_code none;
  const fs::path self = fs::read_symlink("/proc/self/exe", none);
  if (!none) ::execv(self.c_str(), argv);  // its path, so that ps and killall show its name
  ::execv("/proc/self/exe", argv);         // works for a file that was replaced or removed
  throw UsageError(std::string("--processor any cannot start the tool anew (") +
                   std::strerror(errno) + "); start it with " + kVariable + "=" + now);
}

}  // namespace bnvpl
