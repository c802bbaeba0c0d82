// Exceptions are for input and I/O; our own bugs assert. A tool turns each into one line and an
// exit code (tools/common/exit_codes.h).
#pragma once

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace bnvpl {

namespace fs = std::filesystem;

// Each carries one line: file, position, problem; cure.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  InputError(const fs::path& file, const std::string& problem)
      : std::runtime_error(file.string() + ": " + problem) {}
};
class FileError : public InputError {  // a damaged binary file, at a byte
 public:
  FileError(const fs::path& file, uint64_t byte, const std::string& problem)
      : InputError(file.string() + ": byte " + std::to_string(byte) + ": " + problem) {}
};
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};
class MemoryError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};
class OutputError : public std::runtime_error {
 public:
  OutputError(const fs::path& file, const std::string& problem)
      : std::runtime_error(file.string() + ": " + problem) {}
};

}  // namespace bnvpl
