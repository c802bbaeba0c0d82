// Records that pipelines/record.py writes about the tasks of a run: one *.task.json per attempt.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/errors.h"

namespace bnvpl {

// One attempt to run a task. The end is unknown if it still runs or was killed with its machine.
struct TaskAttempt {
  std::string task, stage, host;
  std::string job;  // job id of the scheduler; empty: none
  unsigned number = 1;
  bool resumed = false;  // continued from a checkpoint
  double startS = 0.0;   // seconds since 1970
  std::optional<double> endS, cpuS, peakMemoryMiB;
  std::optional<int> exit;  // 128 and more: ended by a signal

  bool done() const { return exit == 0; }
};

struct RunRecords {
  // Sorted by task, then by number. Attempts of earlier runs of a task are left out: those up to
  // the last success that another attempt follows.
  std::vector<TaskAttempt> attempts;
  std::map<std::string, std::set<std::string>> after;  // for each stage, the stages that it reads
};

// Reads all *.task.json of a folder. Throws InputError, also if there are none.
RunRecords readRunRecords(const fs::path& folder);

}  // namespace bnvpl
