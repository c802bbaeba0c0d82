// Exceptions report errors of input and I/O; bugs are asserted. A tool turns an exception into one
// line and an exit code (tools/common/process/exit_codes.h).
#pragma once

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace bnvpl {

namespace fs = std::filesystem;

// The message of each is one line: file, position, problem; remedy.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  InputError(const fs::path& file, const std::string& problem)
      : std::runtime_error(file.string() + ": " + problem) {}
};
// Returns work(). What it finds wrong is wrong with `file`, which its messages then name.
template <typename Work>
auto withFile(const fs::path& file, const Work& work) {
  try {
    return work();
  } catch (const InputError& e) {
    throw InputError(file, e.what());
  }
}
class FileError : public InputError {  // a damaged binary file, with the byte offset
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
  using std::runtime_error::runtime_error;
  OutputError(const fs::path& file, const std::string& problem)
      : std::runtime_error(file.string() + ": " + problem) {}
};

}  // namespace bnvpl
