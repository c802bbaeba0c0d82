// Reads the files of a scene. They have no checksums: a file that is cut short, by a disk error or
// because it is just being written, could pass for a smaller scene.
#pragma once

#include <string>
#include <string_view>

#include "core/errors.h"

namespace bnvpl {

// Detects changes of a file while it is read.
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

// Says why `file` cannot be read: "no such OBJ file" for `what` "OBJ file", or what the system says
// where a file or folder may not be read.
std::string whyUnreadable(const fs::path& file, const std::string& what);

// Returns the whole file. Throws InputError if it cannot be read to its end, or changes meanwhile.
std::string readText(const fs::path& file);

// Throws InputError if the text looks like UTF-16: it begins with a byte order mark, or one of its
// first two bytes is 0.
void requireNoUtf16(const fs::path& file, std::string_view text);

}  // namespace bnvpl
