#include "formats/atomic_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "formats/output_target.h"

namespace bnvpl {
namespace {

constexpr const char* kPartial = ".partial-";

// Paths for removePartialFiles(), in fixed slots because a signal handler can neither lock nor
// allocate. A run has at most five files open; the next run would remove a file without a slot.
std::array<std::atomic<const char*>, 16> partialFiles;
std::atomic<bool> outputReplaced{false};
static_assert(std::atomic<const char*>::is_always_lock_free);

void remember(const char* path) {
  for (auto& place : partialFiles) {
    const char* empty = nullptr;
    if (place.compare_exchange_strong(empty, path)) return;
  }
}
void forget(const char* path) {
  for (auto& place : partialFiles) {
    const char* same = path;
    if (place.compare_exchange_strong(same, nullptr)) return;
  }
}

// Whether `name` is `prefix` followed by digits, a dash and digits.
bool isPartialName(const std::string& name, const std::string& prefix) {
  if (!name.starts_with(prefix)) return false;
  const std::string rest = name.substr(prefix.size());
  return rest.find_first_not_of("0123456789-") == std::string::npos &&
         std::count(rest.begin(), rest.end(), '-') == 1 && rest.front() != '-' &&
         rest.back() != '-';
}

// Removes the partial files of `target` whose writers were killed, which are not locked.
void removeAbandoned(const fs::path& target) {
  const std::string prefix = target.filename().string() + kPartial;
  std::error_code ignored;
  for (fs::directory_iterator it(folderOf(target), ignored), end; it != end;
       it.increment(ignored)) {
    if (!isPartialName(it->path().filename().string(), prefix)) continue;
    const int fd = ::open(it->path().c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (fd < 0) continue;
    if (::flock(fd, LOCK_EX | LOCK_NB) == 0) ::unlink(it->path().c_str());
    ::close(fd);
  }
}

// Some file systems do not support fsync, which is no failure of the write.
bool syncDescriptor(int fd) {
  while (::fsync(fd) != 0) {
    if (errno == EINTR) continue;
    return errno == EINVAL || errno == ENOTSUP || errno == ENOSYS || errno == EROFS;
  }
  return true;
}

void syncFolder(const fs::path& target) {
  const int fd = ::open(folderOf(target).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) return;  // the rename does not need read permission
  const bool done = syncDescriptor(fd);
  const int error = errno;
  ::close(fd);
  if (!done) {
    throw OutputError(target, std::string("was replaced, but the disk did not confirm it: ") +
                                  std::strerror(error) + "; check the disk and run it again");
  }
}

// Folders whose outputs this process replaces now, and no other: of runs that write the same files,
// the last replaces them all. The locks are advisory (flock). Where one cannot be had, as on a file
// system without locks or while a script holds the folder, waiting ends after two seconds.
class FolderLocks {
 public:
  explicit FolderLocks(const std::vector<fs::path>& folders) {
    for (const fs::path& folder : folders) {
      struct stat info {};
      const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
      if (fd < 0) continue;
      const bool known = ::fstat(fd, &info) == 0;
      if (!known || !open_.emplace(std::pair(info.st_dev, info.st_ino), fd).second) ::close(fd);
    }
    int tries = 400;
    for (const auto& [identity, fd] : open_) {
      while (::flock(fd, LOCK_EX | LOCK_NB) != 0 && (errno == EWOULDBLOCK || errno == EINTR) &&
             --tries > 0)
        ::usleep(5000);
    }
  }
  ~FolderLocks() {
    for (const auto& [identity, fd] : open_) ::close(fd);
  }
  FolderLocks(const FolderLocks&) = delete;
  FolderLocks& operator=(const FolderLocks&) = delete;

 private:
  std::map<std::pair<dev_t, ino_t>, int> open_;  // in an order that all runs share: no deadlock
};

}  // namespace

AtomicFile::AtomicFile(fs::path target)
    : target_(std::move(target)), place_(replaceableTarget(target_)) {
  removeAbandoned(place_);
  open();
}

AtomicFile::~AtomicFile() {
  if (!replaced_) ::unlink(partial_.c_str());
  forget(partial_.c_str());
  ::close(descriptor_);  // also releases the lock
}

void AtomicFile::open() {
  static std::atomic<unsigned> number{0};  // makes names unique within the process
  struct stat info {};
  while (true) {
    partial_ = place_.string() + kPartial + std::to_string(::getpid()) + "-" +
               std::to_string(number.fetch_add(1));
    remember(partial_.c_str());
    descriptor_ = ::open(partial_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0) {
      const int error = errno;
      forget(partial_.c_str());
      if (error == EEXIST) continue;  // a process of another machine or container has the name
      throw OutputError(
          target_,
          std::string("cannot write: ") + std::strerror(error) +
              (error == ENAMETOOLONG ? "; choose a shorter name: it is extended until the file "
                                       "is complete"
                                     : "; choose a folder that exists and is writable"));
    }
    while (::flock(descriptor_, LOCK_EX) != 0 && errno == EINTR) {
    }
    // Another run may have removed it as abandoned in the moment without a lock.
    if (::fstat(descriptor_, &info) == 0 && info.st_nlink > 0) return keepMode();
    ::close(descriptor_);
    forget(partial_.c_str());
  }
}

// Copies the mode of the old file before the first byte is written, so that private content stays
// private. File systems without modes refuse, which is ignored.
void AtomicFile::keepMode() const {
  struct stat old {};
  if (::stat(place_.c_str(), &old) == 0) {
    [[maybe_unused]] const int ignored = ::fchmod(descriptor_, old.st_mode & 07777);
  }
}

void AtomicFile::write(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t done =
        ::write(descriptor_, bytes.data(), std::min(bytes.size(), size_t{1} << 30));
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) fail(errno);
    bytes = bytes.subspan(static_cast<size_t>(done));
  }
}

void AtomicFile::sync() {
  if (!syncDescriptor(descriptor_)) fail(errno);
}

void AtomicFile::replace() {
  outputReplaced = true;  // set before the rename, for a signal in between
  if (::rename(partial_.c_str(), place_.c_str()) != 0) {
    throw OutputError(target_, std::string("cannot replace: ") + std::strerror(errno));
  }
  replaced_ = true;
}

void AtomicFile::commit() {
  sync();
  replace();
  syncFolder(place_);
}

void AtomicFile::withdraw() {
  if (::unlink(partial_.c_str()) == 0 || errno == ENOENT) return;
  throw OutputError(target_, std::string("cannot be renamed into place: the folder does not let a "
                                         "file go (") +
                                 std::strerror(errno) + "); remove " + partial_.string() +
                                 " if it is left, and choose another folder");
}

void AtomicFile::fail(int error) const {
  throw OutputError(target_, std::string("write failed: ") + std::strerror(error) +
                                 "; the old file, if any, is unchanged");
}

// The file comes last, so that a new one has its companions.
void OutputSet::replaceAll() {
  for (auto file = files_.rbegin(); file != files_.rend(); ++file) {
    try {
      file->replace();
    } catch (const OutputError& e) {
      if (file == files_.rbegin()) throw;
      throw OutputError(std::string(e.what()) + "; its companions that came before it are new");
    }
  }
}

void OutputSet::commit() {
  for (AtomicFile& file : files_) file.sync();
  std::vector<fs::path> all;
  for (const AtomicFile& file : files_) all.push_back(folderOf(file.place_));
  const FolderLocks locks(all);
  replaceAll();
  std::set<fs::path> folders;
  for (const AtomicFile& file : files_) {
    if (folders.insert(folderOf(file.place_)).second) syncFolder(file.place_);
  }
}

bool isPartialOf(const fs::path& file, const fs::path& target) {
  std::error_code failed;
  const fs::path place = followLinks(target);
  return isPartialName(file.filename().string(), place.filename().string() + kPartial) &&
         fs::equivalent(folderOf(file), folderOf(place), failed);
}

void removePartialFiles() noexcept {
  for (auto& place : partialFiles) {
    if (const char* path = place.exchange(nullptr)) ::unlink(path);
  }
}

bool anyOutputReplaced() noexcept { return outputReplaced; }

}  // namespace bnvpl
