#include "formats/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

namespace bnvpl {

AtomicFile::AtomicFile(fs::path target)
    : target_(std::move(target)),
      partial_(target_.string() + ".partial-" + std::to_string(::getpid())) {
  std::error_code ignored;
  if (fs::is_directory(target_, ignored)) {
    throw OutputError(target_, "is a folder; name a file");
  }
  // Renaming over /dev/null or a pipe would replace the device itself.
  if (fs::exists(target_, ignored) && !fs::is_regular_file(target_, ignored)) {
    throw OutputError(target_, "is a device or pipe, which cannot be replaced; name a file");
  }
  const int fd = ::open(partial_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (fd < 0) {
    throw OutputError(target_, std::string("cannot write: ") + std::strerror(errno) +
                                   "; choose a folder that exists and is writable");
  }
  ::close(fd);
}

AtomicFile::~AtomicFile() {
  if (!committed_) ::unlink(partial_.c_str());
}

void AtomicFile::commit() {
  if (::rename(partial_.c_str(), target_.c_str()) != 0) {
    throw OutputError(target_, std::string("cannot replace: ") + std::strerror(errno));
  }
  committed_ = true;
}

void writeFileAtomically(const fs::path& target, const std::string& bytes) {
  AtomicFile file(target);
  std::FILE* out = std::fopen(file.path().c_str(), "wb");
  bool ok = out && std::fwrite(bytes.data(), 1, bytes.size(), out) == bytes.size();
  int writeErrno = errno;
  if (out && std::fclose(out) != 0 && ok) {  // the last buffer is written here
    ok = false;
    writeErrno = errno;
  }
  if (!ok) {
    throw OutputError(target, std::string("write failed: ") + std::strerror(writeErrno) +
                                  "; the old file is unchanged");
  }
  file.commit();
}

}  // namespace bnvpl
