#include "formats/output_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <memory>
#include <sstream>

#include "core/hash.h"
#include "formats/atomic_file.h"
#include "formats/output_target.h"

namespace bnvpl {
namespace {

constexpr const char* kListName = "files.list";
constexpr const char* kListHead =
    "# Made by bnvpl, which replaces this folder only while it holds these files, unchanged.\n";
constexpr const char* kCure = "; name a folder that does not exist yet";

// Hexadecimal XXH3-64; empty if the file cannot be read.
std::string checksumOf(const fs::path& file) {
  Hasher hasher;
  std::ifstream in(file, std::ios::binary);
  if (!in) return "";
  std::array<char, 1 << 16> block;
  while (in.read(block.data(), block.size()) || in.gcount() > 0)
    hasher.add(std::as_bytes(std::span(block)).first(static_cast<size_t>(in.gcount())));
  if (in.bad()) return "";
  return hashText(hasher.digest());
}

// Returns false if the folder has no list that bnvpl wrote.
bool readList(const fs::path& folder, std::map<std::string, std::string>& files) {
  std::ifstream in(folder / kListName);
  std::string line;
  if (!std::getline(in, line) || line + "\n" != kListHead) return false;
  while (std::getline(in, line)) {
    std::istringstream words(line);
    std::string checksum, name;
    words >> checksum >> name;
    files[name] = checksum;
  }
  return true;
}

// Describes a file of the folder that is not on the list, or has changed; empty if there is none.
std::string strangerIn(const fs::path& folder) {
  std::map<std::string, std::string> listed;
  const bool ours = readList(folder, listed);
  std::error_code failed;
  for (fs::recursive_directory_iterator it(folder, failed), end; !failed && it != end;
       it.increment(failed)) {
    const std::string name = it->path().lexically_relative(folder).string();
    if (it->symlink_status().type() == fs::file_type::directory) continue;
    if (ours && name == kListName) continue;
    const auto known = listed.find(name);
    if (known == listed.end()) return "holds " + name + ", which is not replaced";
    if (it->symlink_status().type() != fs::file_type::regular ||
        checksumOf(it->path()) != known->second)
      return "holds " + name + ", which was changed since it was written";
  }
  return failed ? "cannot be read: " + failed.message() : "";
}

fs::path withoutSlash(const fs::path& path) {
  return path.has_filename() ? path : path.parent_path();
}

// The newest path of the partial folder, of which a tool has only one. The list is lock-free,
// because a signal handler can neither lock nor allocate.
std::atomic<const OutputFolder::Path*> partialPaths{nullptr};
static_assert(std::atomic<const OutputFolder::Path*>::is_always_lock_free);

}  // namespace

OutputFolder::OutputFolder(const fs::path& target) : target_(withoutSlash(target)) {
  place_ = followLinks(target_);
  std::error_code failed;
  if (fs::exists(place_, failed)) {
    if (!fs::is_directory(place_, failed))
      throw OutputError(target_, std::string("is no folder") + kCure);
    place_ = fs::canonical(place_, failed);
    if (place_ == fs::current_path(failed))
      throw OutputError(target_,
                        std::string("is the current folder, which cannot be replaced") + kCure);
    const std::string stranger = strangerIn(place_);
    if (!stranger.empty()) throw OutputError(target_, stranger + kCure);
  }
  requireRenameTo(place_, target_);
  open();
}

OutputFolder::~OutputFolder() {
  forget();
  std::error_code ignored;
  if (!partial_.empty()) fs::remove_all(partial_, ignored);
  if (lock_ >= 0) ::close(lock_);
}

void OutputFolder::open() {
  std::error_code ignored;
  for (fs::directory_iterator it(folderOf(place_), ignored), end; it != end;
       it.increment(ignored)) {
    if (!it->is_directory(ignored) || !isPartialOf(it->path(), place_)) continue;
    const int fd = ::open(it->path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC | O_NOFOLLOW);
    if (fd < 0) continue;
    if (::flock(fd, LOCK_EX | LOCK_NB) == 0) fs::remove_all(it->path(), ignored);
    ::close(fd);
  }
  static std::atomic<unsigned> number{0};
  for (;;) {
    const fs::path partial = place_.string() + ".partial-" + std::to_string(::getpid()) + "-" +
                             std::to_string(number.fetch_add(1));
    if (!makeFolder(partial)) continue;  // one that was left behind has this name
    partial_ = partial;
    lock_ = ::open(partial_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    // Another run may have removed it as abandoned in the moment without a lock.
    bool gone = lock_ < 0 && errno == ENOENT;
    if (lock_ >= 0) {
      while (::flock(lock_, LOCK_EX) != 0 && errno == EINTR) {
      }
      struct stat info {};
      gone = ::fstat(lock_, &info) == 0 && info.st_nlink == 0;
    }
    if (!gone) return;
    forget();
    if (lock_ >= 0) ::close(lock_);
  }
}

void OutputFolder::remember(const fs::path& path) {
  paths_.push_back({path.string(), paths_.empty() ? nullptr : &paths_.back()});
  partialPaths = &paths_.back();
}

void OutputFolder::forget() {
  partialPaths = nullptr;
  paths_.clear();
}

bool OutputFolder::makeFolder(const fs::path& folder) {
  if (::mkdir(folder.c_str(), 0777) != 0) {
    if (errno == EEXIST) return false;
    throw OutputError(target_, std::string("cannot write: ") + std::strerror(errno) +
                                   "; choose a folder in one that exists and is writable");
  }
  remember(folder);
  return true;
}

fs::path OutputFolder::add(const fs::path& name) {
  const fs::path file = partial_ / name;
  std::error_code failed;
  if (!fs::exists(file.parent_path(), failed)) makeFolder(file.parent_path());
  remember(file);
  files_.push_back(name.string());
  return file;
}

void OutputFolder::writeList() {
  std::string text = kListHead;
  for (const std::string& name : files_) text += checksumOf(partial_ / name) + " " + name + "\n";
  remember(partial_ / kListName);
  AtomicFile list(partial_ / kListName);
  list.write(text);
  list.commit();
}

void OutputFolder::commit() {
  writeList();
  std::error_code failed;
  const bool exchange = fs::exists(place_, failed) && !fs::is_empty(place_, failed);
  const std::string stranger = exchange ? strangerIn(place_) : "";
  if (!stranger.empty()) throw OutputError(target_, stranger + kCure);
  forget();
  if (::renameat2(AT_FDCWD, partial_.c_str(), AT_FDCWD, place_.c_str(),
                  exchange ? RENAME_EXCHANGE : 0) != 0) {
    throw OutputError(target_, std::string("cannot be replaced: ") + std::strerror(errno) + kCure);
  }
  if (!exchange) partial_.clear();  // after an exchange it names the old folder
}

void removePartialFolder() noexcept {
  for (const auto* p = partialPaths.exchange(nullptr); p; p = p->older) {
    if (::unlink(p->name.c_str()) != 0) ::rmdir(p->name.c_str());
  }
}

}  // namespace bnvpl
