// What a tool reports and how it exits. Exceptions are for input and I/O; our own bugs assert.
#pragma once

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace bnvpl {

namespace fs = std::filesystem;

// Exit codes of every tool, documented in docs/tools.md.
inline constexpr int kExitOk = 0;
inline constexpr int kExitInternal = 1;   // a bug of ours
inline constexpr int kExitUsage = 2;      // options that make no sense
inline constexpr int kExitInput = 3;      // input missing, damaged, stale or of the wrong kind
inline constexpr int kExitOutput = 4;     // output could not be written
inline constexpr int kExitDifferent = 5;  // vpl-inspect compare: the limit was exceeded
inline constexpr int kExitMemory = 6;     // not enough memory for what was asked

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
