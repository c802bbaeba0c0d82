// Output that is whole or absent: written beside the target, renamed over it when complete.
#pragma once

#include "core/errors.h"

namespace bnvpl {

// Reserves TARGET.partial-PID. The caller writes to path() and then calls commit(); without that,
// the destructor removes the partial file and the old target stays as it was. Throws OutputError
// when the folder is missing or not writable, at construction: before the work.
class AtomicFile {
 public:
  explicit AtomicFile(fs::path target);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const fs::path& path() const { return partial_; }
  const fs::path& target() const { return target_; }
  void commit();

 private:
  fs::path target_, partial_;
  bool committed_ = false;
};

// Writes `bytes` as the whole content of `target`, atomically.
void writeFileAtomically(const fs::path& target, const std::string& bytes);

}  // namespace bnvpl
