#include "core/read_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

namespace bnvpl {

namespace {
constexpr size_t kReadAtOnce = size_t{1} << 16;  // chunk beyond the size that the system reports
}

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

void requireNoUtf16(const fs::path& file, std::string_view text) {
  if (text.size() < 2) return;
  const std::string_view mark = text.substr(0, 2);
  const bool marked = mark == "\xff\xfe" || mark == "\xfe\xff";
  if (marked || (mark[0] == '\0') != (mark[1] == '\0'))
    throw InputError(file, "is UTF-16 text; save it as UTF-8");
}

std::string whyUnreadable(const fs::path& file, const std::string& what) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  const int error = descriptor < 0 ? errno : 0;
  if (descriptor >= 0) ::close(descriptor);
  if (error == EACCES || error == EPERM || error == ELOOP)
    return std::string("cannot be opened: ") + std::strerror(error);
  return "no such " + what;
}

std::string readText(const fs::path& file) {
  const ReadGuard guard(file);
  std::ifstream in(file, std::ios::binary);
  if (!in) {
    throw InputError(file, std::string("cannot open: ") + std::strerror(errno) +
                               "; check its name and permissions");
  }
  // The reported size is only a hint: files of the system may report 0.
  std::error_code unknown;
  uintmax_t size = fs::file_size(file, unknown);
  if (unknown) size = 0;
  std::string text(size + 1, '\0');  // one more byte, so that one read detects the end
  size_t got = 0;
  do {
    if (got == text.size()) text.resize(got + kReadAtOnce);
    in.read(text.data() + got, static_cast<std::streamsize>(text.size() - got));
    got += static_cast<size_t>(in.gcount());
  } while (in);
  if (in.bad() || got < size) {
    throw InputError(file, "cannot be read to its end; check the disk");
  }
  text.resize(got);
  guard.check();
  return text;
}

}  // namespace bnvpl
