// --checkpoint FILE: a long stage can be stopped and continued, with the same bytes in the end.
#pragma once

#include <optional>

#include "core/resume.h"
#include "tools/common/interrupt.h"
#include "tools/common/run_tool.h"

namespace bnvpl {

// The first thing in which two runs differ: "options photons was 10000000 and is now 5000000".
std::string differenceOf(const Json& before, const Json& now);

struct CheckpointOptions {
  fs::path file;  // empty: none
  double everyS = 60.0;
  bool replace = false;  // one that is damaged or of another run counts as none
};

// --checkpoint, --checkpoint-every and --checkpoint-replace. They do not change what is computed.
void addCheckpointOptions(CLI::App& cli, CheckpointOptions& options);

class Checkpoint {
 public:
  // `run` names everything that decides the result: tool, version, options, inputs; processorId()
  // joins it. Reads the file where there is one. Throws InputError when it is damaged or belongs to
  // another run, unless such checkpoints are to be replaced; OutputError when it could not be
  // written later.
  Checkpoint(CheckpointOptions options, Json run);

  // For the stage: what was done before; pauses every so often, and when the user interrupts, which
  // throws Interrupted once the work is saved. Without --checkpoint: nothing. Must not outlive
  // this.
  Resume resume();

  // Once the output stands; interruptions are no longer deferred. What is no checkpoint stays.
  void remove();

 private:
  bool due() const;
  void save(const std::string& state);

  CheckpointOptions options_;
  Json run_;
  std::string earlier_;
  double nextS_;
  std::optional<DeferInterrupts> defer_;
};

}  // namespace bnvpl
