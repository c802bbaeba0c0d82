// A folder of outputs that is whole or absent: filled beside its place, then renamed to it.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "core/errors.h"

namespace bnvpl {

// Reserves TARGET.partial-PID-N beside the target. commit() adds a list of the files with their
// checksums and renames the folder; without it, the destructor removes what was written. The target
// may be absent, empty, or hold exactly the files of such a list, unchanged: then it is exchanged
// for the new folder in one step. Anything else is somebody's, and refused.
//
// A process that is killed leaves its partial folder behind, locked (flock) while it lived; the
// next run with the same target removes it.
//
// All members throw OutputError.
class OutputFolder {
 public:
  struct Path {  // of a list for a signal handler, the youngest first
    std::string name;
    const Path* older;
  };
  explicit OutputFolder(const fs::path& target);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  const fs::path& target() const { return target_; }
  // Where the files are written until commit().
  const fs::path& partial() const { return partial_; }
  // The place of a file, `name` being relative; its folder is there.
  fs::path add(const fs::path& name);
  void commit();

 private:
  void open();
  void remember(const fs::path& path);
  void forget();
  void makeFolder(const fs::path& folder);
  void writeList();

  fs::path target_, place_, partial_;  // as named; without links; what is filled
  std::deque<Path> paths_;             // does not move its elements
  std::vector<std::string> files_;     // their names
  int lock_ = -1;
};

// For a process that is about to end in the middle of something; may be called from a signal
// handler.
void removePartialFolder() noexcept;

}  // namespace bnvpl
