#include "scene/read_file.h"

#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <utility>

namespace bnvpl {

ReadGuard::ReadGuard(fs::path file) : file_(std::move(file)), before_(look()) {}

ReadGuard::Look ReadGuard::look() const {
  struct stat info {};
  if (::stat(file_.c_str(), &info) != 0) return {};
  return {true, info.st_size, static_cast<int64_t>(info.st_ino), info.st_mtim.tv_sec,
          info.st_mtim.tv_nsec};
}

void ReadGuard::check() const {
  if (look() == before_) return;
  throw InputError(file_, "was changed while it was read; run again when it is complete");
}

std::string readText(const fs::path& file) {
  const ReadGuard guard(file);
  std::ifstream in(file, std::ios::binary);
  if (!in) {
    throw InputError(file, std::string("cannot open: ") + std::strerror(errno) +
                               "; check its name and permissions");
  }
  std::ostringstream text;
  text << in.rdbuf();  // fails for an empty file too
  std::error_code ignored;
  if (!text && fs::file_size(file, ignored) > 0) {
    throw InputError(file, "cannot be read to its end; check the disk");
  }
  guard.check();
  return std::move(text).str();
}

}  // namespace bnvpl
