// --checkpoint FILE: a long stage can be stopped and resumed without a change to its output.
#pragma once

#include <optional>

#include "core/work_controls.h"
#include "tools/common/process/interrupt.h"
#include "tools/common/run/run_tool.h"

namespace bnvpl {

// Describes the first difference of two runs: "options photons was 10000000 and is now 5000000".
std::string differenceOf(const Json& before, const Json& now);

struct CheckpointOptions {
  fs::path file;  // empty: no checkpoint
  double everyS = 60.0;
  bool replace = false;  // start over if the file is damaged or of another run
};

// Adds --checkpoint, --checkpoint-every and --checkpoint-replace, none of which changes the result.
void addCheckpointOptions(CLI::App& cli, CheckpointOptions& options);

class Checkpoint {
 public:
  // `run` names everything that determines the result: tool, version, options and inputs; the
  // constructor adds processorId(). Reads the file if it exists. Throws InputError if the file is
  // damaged or belongs to another run, unless it is a checkpoint and options.replace is set, and
  // OutputError if it cannot be written.
  Checkpoint(CheckpointOptions options, Json run);

  // For the stage: the saved state, and pauses every options.everyS seconds and at an interrupt.
  // After an interrupt save() throws Interrupted once the state is on disk. Empty without
  // --checkpoint. Must not outlive this object.
  WorkControls controls();

  // Removes the file once the output is written, unless it is not a checkpoint; ends the deferral
  // of interrupts.
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
