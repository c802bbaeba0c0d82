// The opening of a .vpl file, which is verified without reading the values. Internal to
// vpl_read.cpp.
#pragma once

#include <string>

#include "core/errors.h"
#include "formats/vpl/vpl_layout.h"

namespace bnvpl {

// A regular file that is read sequentially.
class InputFile {
 public:
  explicit InputFile(const fs::path& path);  // throws InputError
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  const fs::path& path() const { return path_; }
  uint64_t size() const { return size_; }

  // Reads the next `bytes` bytes. Throws FileError.
  void read(void* to, uint64_t bytes);
  // Throws FileError with the remedy for a damaged file.
  [[noreturn]] void fail(uint64_t byte, const std::string& problem) const;

 private:
  fs::path path_;
  int descriptor_ = -1;
  uint64_t size_ = 0;
  uint64_t position_ = 0;
};

struct Opening {
  VplHeader header;
  VplTable shape;  // stage and extra columns, without values
  VplLayout layout;
};

// Reads header and directory, and verifies them against the format and the real size of the file.
// The provenance comes next. Allocates no more than the directory. Throws FileError,
// or InputError for a shard or a checkpoint.
Opening readOpening(InputFile& in);

}  // namespace bnvpl
