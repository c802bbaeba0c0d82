// Asking about files without exceptions.
#pragma once

#include <cctype>
#include <filesystem>
#include <string>
#include <system_error>

namespace bnvpl {

// False for folders, for pipes and devices, which may never end, and for names that the system
// refuses, on which std::filesystem::is_regular_file(file) throws. Ask before opening: opening a
// pipe waits for its other end.
inline bool isRegularFile(const std::filesystem::path& file) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(file, ignored);
}

// ".ply", also of a.PLY; empty where there is none.
inline std::string lowerExtension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

}  // namespace bnvpl
