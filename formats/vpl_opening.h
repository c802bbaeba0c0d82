// The start of a .vpl file: what can be known, and is verified, without reading the values.
// Internal to vpl_read.cpp.
#pragma once

#include <string>

#include "core/errors.h"
#include "formats/vpl_layout.h"

namespace bnvpl {

// A regular file, read from its start to its end.
class InputFile {
 public:
  explicit InputFile(const fs::path& path);  // throws InputError
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  const fs::path& path() const { return path_; }
  uint64_t size() const { return size_; }

  // The next `bytes` bytes of the file. Throws FileError.
  void read(void* to, uint64_t bytes);
  // FileError with the cure for a damaged file.
  [[noreturn]] void fail(uint64_t byte, const std::string& problem) const;

 private:
  fs::path path_;
  int descriptor_ = -1;
  uint64_t size_ = 0;
  uint64_t position_ = 0;
};

struct Opening {
  VplHeader header;
  VplTable shape;  // stage and strategies' columns, without a value
  VplLayout layout;
};

// Header and directory, verified against the constants and the real size of the file; the
// provenance comes next. Allocates no more than the directory's size. Throws FileError.
Opening readOpening(InputFile& in);

}  // namespace bnvpl
