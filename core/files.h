// Asking about files without exceptions.
#pragma once

#include <filesystem>
#include <system_error>

namespace bnvpl {

// False for folders, for pipes and devices, which may never end, and for names that the system
// refuses, on which std::filesystem::is_regular_file(file) throws. Ask before opening: opening a
// pipe waits for its other end.
inline bool isRegularFile(const std::filesystem::path& file) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(file, ignored);
}

}  // namespace bnvpl
