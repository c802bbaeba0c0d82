// Queries about files that do not throw.
#pragma once

#include <cctype>
#include <filesystem>
#include <string>
#include <system_error>

namespace bnvpl {

// False for folders, for pipes and devices, which may never end, and for names that the system
// rejects. Call it before opening a file: opening a pipe blocks until its other end is open.
inline bool isRegularFile(const std::filesystem::path& file) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(file, ignored);
}

// The path without symbolic links, as far as it exists and can be followed.
inline std::filesystem::path realPath(const std::filesystem::path& file) {
  std::error_code failed;
  std::filesystem::path real = std::filesystem::weakly_canonical(file, failed);
  return failed ? file.lexically_normal() : real;
}

inline std::string lowered(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

// The extension in lower case, such as ".ply"; empty if there is none.
inline std::string lowerExtension(const std::filesystem::path& file) {
  return lowered(file.extension().string());
}

}  // namespace bnvpl
