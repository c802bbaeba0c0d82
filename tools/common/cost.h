// --estimate: what a run will need, by doing a small part of it.
#pragma once

#include <functional>
#include <optional>

#include "core/cost_probe.h"
#include "core/resume.h"
#include "tools/common/run_tool.h"

namespace bnvpl {

struct CostOptions {
  bool estimate = false, json = false;
};
// --estimate and --json. A run that estimates writes nothing.
void addCostOptions(CLI::App& cli, CostOptions& options);

// CPU seconds of this process so far, all its threads together.
double cpuSecondsSoFar();

// The most memory that the process has held since this was made, and what it held then, in bytes.
// Where Linux does not let a process forget its peak, the peak is that since its start.
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
  double setupCpuS = 0.0;  // what each shard does again: loading, and all that goes before units
  double workCpuS = 0.0;   // what shards share out
  double probed = 1.0;     // of the work, that was done to know this
  bool sure = true;        // else that was too little: units of the work take too long

  Cost ofShard(const std::optional<Shard>& shard) const;  // none: all of it
};

struct UnitsToTry {
  double fewest = 32.0;  // they differ
  bool apart = false;    // they will be done in shards, where neighbours share nothing
};
// Of work in units, by `part`, which does those of resume.shard: first of none, then of more and
// more, until what they take can be told from the rest, or takes seconds. Preparations that go by
// resume.probe count in full.
Cost costOfUnits(const std::function<void(const Resume&)>& part, CostProbe& probe,
                 const UnitsToTry& units = {});

// Of work on rows, by `part`, which does it for so many of them: of `first`, then more and more,
// until that can be measured. `growth` tells how the CPU time goes with rows, but for a factor and
// what is the same for any number; it is asked after `part`. Memory goes with the rows.
Cost costOfRows(uint64_t rows, uint64_t first, const std::function<void(uint64_t)>& part,
                const std::function<double(uint64_t)>& growth);

// One line, or with --json an object.
void printCost(const Cost& cost, const CostOptions& options);

}  // namespace bnvpl
