// Output that is whole or absent: it is written beside the target, synced to disk, then renamed.
#pragma once

#include <cstddef>
#include <deque>
#include <span>
#include <string>

#include "core/errors.h"

namespace bnvpl {

// Creates TARGET.partial-PID-N; if TARGET is a symbolic link, beside the file that it leads to, and
// the link stays. The new file has the mode of the old one, or by the umask if there is none. Other
// hard links keep the old content. The caller calls write() any number of times, then commit();
// without it, the destructor removes the partial file and the old target is unchanged.
//
// A partial file is locked (flock) while its writer lives. If the writer is killed, the next run
// with the same target recognises the file as abandoned and removes it, unless the file system does
// not support locks.
//
// All members throw OutputError; the constructor throws if the target cannot be replaced (see
// output_target.h). An AtomicFile that is never committed can thus test the target before the work.
class AtomicFile {
 public:
  explicit AtomicFile(fs::path target);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const fs::path& target() const { return target_; }
  void write(std::span<const std::byte> bytes);
  void write(const std::string& bytes) { write(std::as_bytes(std::span(bytes))); }
  void commit();
  // Ends a trial: removes the partial file. Throws OutputError where the folder takes files and
  // does not let them go, so that a rename would fail, too.
  void withdraw();

 private:
  friend class OutputSet;
  void open();
  void keepMode() const;
  void sync();     // flushes the content to disk
  void replace();  // renames the file; the folder remains to be synced
  [[noreturn]] void fail(int error) const;

  fs::path target_, place_, partial_;  // target as given; with links resolved; file being written
  int descriptor_ = -1;
  bool replaced_ = false;
};

// Output files of one run that belong together, such as an image, its preview and its depfile. None
// is replaced before all are on disk. Where several runs write the same files at once, all are of
// one run in the end.
class OutputSet {
 public:
  // The main output is added first. It is replaced last, so that a new one has its companions.
  AtomicFile& add(const fs::path& target) { return files_.emplace_back(target); }
  void commit();

 private:
  void replaceAll();
  std::deque<AtomicFile> files_;  // a deque does not move its elements
};

// Whether `file` has the name of a partial file of `target`, and so would be removed as abandoned.
bool isPartialOf(const fs::path& file, const fs::path& target);

// For a process that is about to end. Both may be called from a signal handler that runs on the
// thread which writes the files.
void removePartialFiles() noexcept;
bool anyOutputReplaced() noexcept;  // whether this process has replaced an output, or is about to

}  // namespace bnvpl
