#include "formats/output_target.h"

#include <fcntl.h>
#include <linux/capability.h>
#include <linux/magic.h>
#include <sys/stat.h>
#include <sys/syscall.h>
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

// CAP_FOWNER, which root mostly has: the sticky bit does not bind the process.
bool actsAsAnyOwner() {
  __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
  __user_cap_data_struct sets[_LINUX_CAPABILITY_U32S_3]{};
  if (::syscall(SYS_capget, &header, sets) != 0) return ::geteuid() == 0;
  return (sets[0].effective & (1U << CAP_FOWNER)) != 0;
}

// Attributes of a file or folder, such as STATX_ATTR_APPEND; 0 where the system tells none.
uint64_t attributesOf(const fs::path& path) {
  struct statx info {};
  if (::statx(AT_FDCWD, path.c_str(), 0, STATX_BASIC_STATS, &info) != 0) return 0;
  return info.stx_attributes & info.stx_attributes_mask;
}

// Why a rename to `target` would fail although the folder may be written; empty: it would not.
std::string obstacleTo(const fs::path& target) {
  const fs::path folder = folderOf(target);
  if (attributesOf(folder) & STATX_ATTR_APPEND)
    return "cannot write: its folder only lets files be added (chattr +a), and an output is "
           "renamed into place; choose another folder";
  struct stat file {
  }, around{};
  if (::stat(target.c_str(), &file) != 0) return "";
  const uint64_t attributes = attributesOf(target);
  if (attributes & STATX_ATTR_MOUNT_ROOT)
    return "cannot replace: it is a mount of its own; mount its folder, or name another file";
  if (attributes & (STATX_ATTR_APPEND | STATX_ATTR_IMMUTABLE))
    return "cannot replace: it is protected (chattr +a or +i); name another file";
  if (::stat(folder.c_str(), &around) != 0 || (around.st_mode & S_ISVTX) == 0) return "";
  const uid_t user = ::geteuid();
  if (file.st_uid == user || around.st_uid == user || actsAsAnyOwner()) return "";
  return "cannot replace: it is another user's, in a folder with the sticky bit; name another "
         "file or folder";
}

}  // namespace

fs::path folderOf(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

fs::path followLinks(const fs::path& file) { return linkChain(file).back(); }

void requireRenameTo(const fs::path& target, const fs::path& output) {
  const std::string obstacle = obstacleTo(target);
  if (!obstacle.empty()) throw OutputError(output, obstacle);
}

fs::path replaceableTarget(const fs::path& output) {
  const auto fail = [&](const std::string& problem) { return OutputError(output, problem); };
  if (output == "-") {
    throw fail(
        "means standard output elsewhere; outputs go to files, which are replaced whole; "
        "name a file (./- for this name)");
  }
  const std::vector<fs::path> chain = linkChain(output);
  for (const fs::path& link : chain) {
    if (isStream(link))
      throw fail("is an open stream; outputs go to files, which are replaced whole; name a file");
  }
  const fs::path& target = chain.back();
  if (isLink(target)) throw fail("is a loop of links; name a file");
  // The system is asked once, for another run may remove or replace the file meanwhile.
  std::error_code ignored;
  const fs::file_type type = fs::status(target, ignored).type();
  if (type == fs::file_type::directory) throw fail("is a folder; name a file");
  if (type != fs::file_type::not_found && type != fs::file_type::none) {
    // Renaming over /dev/null or a pipe would replace the device itself.
    if (type != fs::file_type::regular)
      throw fail("is a device or pipe, which cannot be replaced; name a file");
    // A rename would also replace a read-only file, which its owner wants to keep.
    if (!mayWrite(target, W_OK) && errno != ENOENT) {
      throw fail(std::string("cannot replace: ") + std::strerror(errno) +
                 "; make it writable or name another file");
    }
  }
  if (!mayWrite(folderOf(target), W_OK | X_OK)) {
    throw fail(std::string("cannot write: ") + std::strerror(errno) +
               "; choose a folder that exists and is writable");
  }
  requireRenameTo(target, output);
  return target;
}

}  // namespace bnvpl
