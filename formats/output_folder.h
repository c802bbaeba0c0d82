// A folder of outputs that is whole or absent: it is filled beside the target, then renamed to it.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "core/errors.h"

namespace bnvpl {

// Creates TARGET.partial-PID-N beside the target. commit() adds a list of the files with their
// checksums and renames the folder; without it, the destructor removes the folder. The target may
// be absent, empty, or hold exactly the unchanged files of such a list: it is then exchanged for
// the new folder atomically. Any other target is refused.
//
// A partial folder is locked (flock) while its process lives. If the process is killed, the next
// run with the same target removes the folder.
//
// All members throw OutputError.
class OutputFolder {
 public:
  struct Path {  // an entry of the list that a signal handler reads, newest first
    std::string name;
    const Path* older;
  };
  explicit OutputFolder(const fs::path& target);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  const fs::path& target() const { return target_; }
  // The folder in which files are written until commit().
  const fs::path& partial() const { return partial_; }
  // Registers a file with a relative name, and creates its folder. Returns the path to write to.
  fs::path add(const fs::path& name);
  void commit();

 private:
  void open();
  void remember(const fs::path& path);
  void forget();
  bool makeFolder(const fs::path& folder);
  void writeList();

  fs::path target_, place_, partial_;  // target as given; with links resolved; folder being filled
  std::deque<Path> paths_;             // a deque does not move its elements
  std::vector<std::string> files_;     // relative names of the files
  int lock_ = -1;
};

// Removes the partial folder of a process that is about to end. May be called from a signal handler
// that runs on the thread which writes the folder.
void removePartialFolder() noexcept;

}  // namespace bnvpl
