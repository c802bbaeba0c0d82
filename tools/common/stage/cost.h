// --estimate: predicts the CPU time and memory of a run from a small part of it.
#pragma once

#include <functional>
#include <optional>

#include "core/cost_trial.h"
#include "core/work_controls.h"
#include "tools/common/run/run_tool.h"

namespace bnvpl {

struct CostOptions {
  bool estimate = false, json = false;
};
// Adds --estimate and --json. A run that estimates writes no files.
void addCostOptions(CLI::App& cli, CostOptions& options);

// CPU seconds that all threads of this process have used so far.
double cpuSecondsSoFar();

// Peak memory of the process since construction, and its memory at construction, in bytes. Where
// Linux does not let a process reset its peak, the peak counts from the start of the process.
class MemoryWatch {
 public:
  MemoryWatch();
  double before() const { return before_; }
  double peak() const;

 private:
  double before_;
};

struct Cost {
  double memoryBytes = 0.0;
  double setupCpuS = 0.0;  // repeated by each shard: loading, and all else before the units
  double workCpuS = 0.0;   // divided among the shards
  double probed = 1.0;     // share of the work that was done for this estimate
  bool sure = true;        // false: that share was too small, because single units take long

  Cost ofShard(const std::optional<Shard>& shard) const;  // none: the whole work
};

struct UnitsToTry {
  double fewest = 32.0;  // min number of units, since their costs differ
  bool apart = false;    // the work will run in shards, where neighbouring units share no results
};
// Estimates work that consists of units. `part` does the units of controls.shard: first none, then
// more and more, until their CPU time stands out from the rest or reaches seconds. Preparations
// that use controls.trial count in full.
Cost costOfUnits(const std::function<void(const WorkControls&)>& part, CostTrial& trial,
                 const UnitsToTry& units = {});

// Estimates work on rows. `part` does it for a number of rows: `first`, then more and more, until
// the CPU time can be measured. That time is a * growth(rows) + b with unknown a and b; `growth` is
// called after `part`. Memory beyond that at the start is proportional to the rows.
Cost costOfRows(uint64_t rows, uint64_t first, const std::function<void(uint64_t)>& part,
                const std::function<double(uint64_t)>& growth);

// Prints one line, or a JSON object with --json.
void printCost(const Cost& cost, const CostOptions& options);

}  // namespace bnvpl
