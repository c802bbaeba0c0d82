// Output that is whole or absent: written beside the target, put on the disk, then renamed over it.
#pragma once

#include <cstddef>
#include <deque>
#include <span>
#include <string>

#include "core/errors.h"

namespace bnvpl {

// Reserves TARGET.partial-PID-N, beside the end of all links where TARGET is one: the links stay.
// The new file has the mode of the one that it replaces; where there is none, the umask decides.
// Other hard links keep the old content. The caller calls write() as often as it likes and then
// commit(); without that, the destructor removes the partial file and the old target stays as it
// was.
//
// A process that is killed leaves its partial file behind. Each one is locked (flock) while its
// writer lives, so the next run that writes the same target knows it as abandoned and removes it.
// Where a file system knows no locks, it stays for the user to remove.
//
// All members throw OutputError; the constructor when the target cannot be replaced (see
// output_target.h), so that a probe before the work is an AtomicFile that is never committed.
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

 private:
  friend class OutputSet;
  void open();
  void keepMode() const;
  void sync();     // what was written is on the disk when it returns
  void replace();  // the rename; only the folder is still to be synchronised
  [[noreturn]] void fail(int error) const;

  fs::path target_, place_, partial_;  // as named; without links; what is written
  int descriptor_ = -1;
  bool replaced_ = false;
};

// Files that one run makes and that belong together, such as an image, its preview and its depfile.
// None is replaced before all are whole on the disk.
class OutputSet {
 public:
  // The product goes first: it is replaced last, so that a new one has its companions.
  AtomicFile& add(const fs::path& target) { return files_.emplace_back(target); }
  void commit();

 private:
  std::deque<AtomicFile> files_;  // does not move its elements
};

// Whether `file` has the name of a partial file of `target`: it would be taken for abandoned.
bool isPartialOf(const fs::path& file, const fs::path& target);

// For a process that is about to end in the middle of something: both may be called from a signal
// handler.
void removePartialFiles() noexcept;
bool anyOutputReplaced() noexcept;  // by this process, or just being so

}  // namespace bnvpl
