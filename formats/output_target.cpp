#include "formats/output_target.h"

#include <fcntl.h>
#include <linux/magic.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <vector>

namespace bnvpl {
namespace {

constexpr size_t kMaxLinks = 40;  // the kernel's limit

bool isLink(const fs::path& path) {
  std::error_code ignored;
  return fs::is_symlink(path, ignored);
}

// `file` and the targets of its chain of links.
std::vector<fs::path> linkChain(const fs::path& file) {
  std::vector<fs::path> chain{file};
  while (isLink(chain.back()) && chain.size() <= kMaxLinks) {
    std::error_code failed;
    const fs::path next = fs::read_symlink(chain.back(), failed);
    if (failed) break;
    chain.push_back(next.is_absolute() ? next : folderOf(chain.back()) / next);
  }
  return chain;
}

// Whether the path is in /proc, where /dev/stdout and /dev/fd/1 lead. They may end at a regular
// file, but one that a process holds open: after a rename it would write to the old file.
bool isStream(const fs::path& path) {
  struct statfs info {};
  return ::statfs(folderOf(path).c_str(), &info) == 0 && info.f_type == PROC_SUPER_MAGIC;
}

bool mayWrite(const fs::path& path, int mode) {
  return ::faccessat(AT_FDCWD, path.c_str(), mode, AT_EACCESS) == 0;
}

}  // namespace

fs::path folderOf(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

fs::path followLinks(const fs::path& file) { return linkChain(file).back(); }

fs::path replaceableTarget(const fs::path& output) {
  const auto fail = [&](const std::string& problem) { return OutputError(output, problem); };
  const std::vector<fs::path> chain = linkChain(output);
  for (const fs::path& link : chain) {
    if (isStream(link))
      throw fail("is an open stream; outputs go to files, which are replaced whole; name a file");
  }
  const fs::path& target = chain.back();
  if (isLink(target)) throw fail("is a loop of links; name a file");
  std::error_code ignored;
  if (fs::is_directory(target, ignored)) throw fail("is a folder; name a file");
  if (fs::exists(target, ignored)) {
    // Renaming over /dev/null or a pipe would replace the device itself.
    if (!fs::is_regular_file(target, ignored))
      throw fail("is a device or pipe, which cannot be replaced; name a file");
    // A rename would also replace a read-only file, which its owner wants to keep.
    if (!mayWrite(target, W_OK)) {
      throw fail(std::string("cannot replace: ") + std::strerror(errno) +
                 "; make it writable or name another file");
    }
  }
  if (!mayWrite(folderOf(target), W_OK | X_OK)) {
    throw fail(std::string("cannot write: ") + std::strerror(errno) +
               "; choose a folder that exists and is writable");
  }
  return target;
}

}  // namespace bnvpl
