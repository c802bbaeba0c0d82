// What pipelines/record.py wrote about the tasks of a run: one file an attempt, *.task.json.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/errors.h"

namespace bnvpl {

// One start of a task. Of one that was killed with its machine, or that still runs, the end is not
// known.
struct TaskAttempt {
  std::string task, stage, host;
  std::string job;  // of the scheduler; empty: none
  unsigned number = 1;
  bool resumed = false;  // went on from a checkpoint
  double startS = 0.0;   // since 1970
  std::optional<double> endS, cpuS, peakMemoryMiB;
  std::optional<int> exit;  // 128 and more: ended by a signal

  bool done() const { return exit == 0; }
};

struct RunRecords {
  // By task, then by number. Those that an earlier run of a task ended with are left out: what
  // precedes a success that was followed by another attempt.
  std::vector<TaskAttempt> attempts;
  std::map<std::string, std::set<std::string>> after;  // of each stage: those whose files it reads
};

// Reads all *.task.json of a folder. Throws InputError, also where there are none.
RunRecords readRunRecords(const fs::path& folder);

}  // namespace bnvpl
