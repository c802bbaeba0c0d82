// Reading the files of a scene. None has a checksum of its own: half of one, because the disk
// failed or because somebody is just writing it, could pass for a smaller scene.
#pragma once

#include <string>
#include <string_view>

#include "core/errors.h"

namespace bnvpl {

// Notices that a file is changed while it is read.
class ReadGuard {
 public:
  explicit ReadGuard(fs::path file);
  void check() const;  // after reading; throws InputError

 private:
  struct Look {
    bool found;
    int64_t size, inode, changedS, changedNs;
    bool operator==(const Look&) const = default;
  };
  Look look() const;

  fs::path file_;
  Look before_;
};

// The whole file. Throws InputError when it cannot be read to its end, or changes meanwhile.
std::string readText(const fs::path& file);

// Throws InputError when the text, which a parser takes for bytes, begins as UTF-16 does: with its
// byte order mark, or with one half of a character 0.
void requireNoUtf16(const fs::path& file, std::string_view text);

}  // namespace bnvpl
