// Notices that a file is changed while it is read. Scenes come from many files, none of which has a
// checksum of its own; half of one could pass for a smaller scene.
#pragma once

#include <sys/stat.h>

#include <utility>

#include "core/errors.h"

namespace bnvpl {

class ReadGuard {
 public:
  explicit ReadGuard(fs::path file) : file_(std::move(file)), before_(look()) {}  // then read it
  void check() const {
    const Look now = look();
    if (now.found && before_.found && now.size == before_.size && now.inode == before_.inode &&
        now.changedS == before_.changedS && now.changedNs == before_.changedNs) {
      return;
    }
    throw InputError(file_, "was changed while it was read; run again when it is complete");
  }

 private:
  struct Look {
    bool found = false;
    off_t size = 0;
    ino_t inode = 0;
    time_t changedS = 0;
    long changedNs = 0;
  };
  Look look() const {
    struct stat info {};
    if (::stat(file_.c_str(), &info) != 0) return {};
    return {true, info.st_size, info.st_ino, info.st_mtim.tv_sec, info.st_mtim.tv_nsec};
  }

  fs::path file_;
  Look before_;
};

}  // namespace bnvpl
