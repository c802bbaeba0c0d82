#include "tools/common/stage/cost.h"

#include <sys/resource.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <fstream>

#include "core/memory.h"
#include "tools/common/files/standard_streams.h"
#include "tools/common/options/help.h"

namespace bnvpl {
namespace {

constexpr double kMinCpuS = 0.5;   // CPU time of a trial, if the work is that long
constexpr double kMaxCpuS = 10.0;  // CPU time of all trials, if single units are short

struct TriedUnits {
  double cpuS = 0.0, units = 0.0;
};

TriedUnits tryUnits(const std::function<void(const WorkControls&)>& part, const Shard& shard,
                    CostTrial& trial, bool apart) {
  std::atomic<uint64_t> units{0};
  const ShardSink nowhere{[](std::string_view, uint64_t, std::string_view) {},
                          [](std::string_view, std::span<const int64_t>) {}};
  WorkControls controls;
  controls.shard = shard;
  controls.sink = &nowhere;
  controls.trial = &trial;
  controls.pause = [&] {  // called once after each unit
    units.fetch_add(1, std::memory_order_relaxed);
    return false;
  };
  controls.save = [](const std::string&) {};
  trial.share = apart ? 1.0 : static_cast<double>(shard.parts()) / static_cast<double>(shard.of);
  const double before = cpuSecondsSoFar() + trial.skippedCpuS();
  part(controls);
  return {cpuSecondsSoFar() + trial.skippedCpuS() - before, static_cast<double>(units)};
}

// The middle one of about `parts` parts. Their number is odd: rows of an image often have an even
// number of tiles, and one of an even number of parts would then hold whole columns.
Shard middleOf(double parts) {
  const uint64_t of = static_cast<uint64_t>(parts) | 1;
  return {of / 2, of / 2 + 1, of};
}

}  // namespace

void addCostOptions(CLI::App& cli, CostOptions& options) {
  CLI::Option* estimate = inTopic(
      Topic::Speed, cli.add_flag("--estimate", options.estimate,
                                 "do a small part of the work, print the estimated CPU time and "
                                 "memory, and write nothing"));
  inTopic(Topic::Expert, cli.add_flag("--json", options.json, "print the estimate as JSON"))
      ->needs(estimate);
}

double cpuSecondsSoFar() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

MemoryWatch::MemoryWatch() : before_(static_cast<double>(residentMemory())) {
  std::ofstream("/proc/self/clear_refs") << "5\n";  // resets the peak
}

double MemoryWatch::peak() const { return static_cast<double>(peakMemory()); }

Cost Cost::ofShard(const std::optional<Shard>& shard) const {
  Cost cost = *this;
  if (shard) cost.workCpuS *= static_cast<double>(shard->parts()) / static_cast<double>(shard->of);
  return cost;
}

Cost costOfUnits(const std::function<void(const WorkControls&)>& part, CostTrial& trial,
                 const UnitsToTry& units) {
  constexpr uint64_t kNone = uint64_t{1} << 40;  // more parts than any work has units
  const double startS = cpuSecondsSoFar() + trial.skippedCpuS();
  const double setupS = tryUnits(part, {kNone - 1, kNone, kNone}, trial, units.apart).cpuS;
  // Results that the first run keeps for all others count once, in setupS.
  const double begunS = cpuSecondsSoFar();
  const TriedUnits base = tryUnits(part, {kNone - 1, kNone, kNone}, trial, units.apart);
  const double baseS = cpuSecondsSoFar() - begunS, enoughS = std::max(kMinCpuS, 0.5 * baseS);
  // The first units may include preparations. The cost of a unit is therefore the slope between two
  // trials that ran some units.
  TriedUnits fewer{base.cpuS, 0.0};
  double fewerShare = 0.0;
  for (double parts = 4096.0;;) {
    const Shard shard = parts > 1.0 ? middleOf(parts) : Shard{};
    const double beforeS = cpuSecondsSoFar(), leftOutS = trial.skippedCpuS();
    const TriedUnits some = tryUnits(part, shard, trial, units.apart);
    const double ownS = cpuSecondsSoFar() - beforeS - baseS,  // CPU time of the units
        leftS = kMaxCpuS - (cpuSecondsSoFar() - begunS) - baseS;
    const double share = 1.0 / static_cast<double>(shard.of);
    const bool enough = some.units >= units.fewest && ownS >= enoughS;
    if (shard.whole() || enough || leftS <= 0.0) {
      const double workS = std::max(0.0, some.cpuS - fewer.cpuS) / (share - fewerShare);
      const double firstS = std::max(0.0, some.cpuS - workS * share - base.cpuS);
      const bool sure = some.units >= units.fewest && ownS >= 0.2 * enoughS;
      const double done = 1.0 - (trial.skippedCpuS() - leftOutS) / std::max(some.cpuS, 1e-9);
      return {static_cast<double>(peakMemory()), startS + setupS + firstS, workS, share * done,
              sure || shard.whole()};
    }
    const double measuredS = std::max(ownS, 0.03 * std::max(baseS, kMinCpuS));  // above noise
    double more = 1.3 * std::max(units.fewest / std::max(some.units, 0.5), enoughS / measuredS);
    more = std::clamp(more, 2.0, 64.0);
    if (some.units > 0.0) {
      more = std::min(more, std::max(1.5, leftS / measuredS));
      fewer = some;
      fewerShare = share;
    }
    parts /= more;
    if (parts < 3.0) parts = 1.0;
  }
}

Cost costOfRows(uint64_t rows, uint64_t first, const std::function<void(uint64_t)>& part,
                const std::function<double(uint64_t)>& growth) {
  const double startS = cpuSecondsSoFar();
  double fewerS = 0.0, fewer = 0.0;  // CPU seconds and growth of the previous trial
  for (uint64_t some = std::min(rows, first);; some = std::min(rows, 4 * some)) {
    const MemoryWatch memory;
    const double before = cpuSecondsSoFar();
    part(some);
    const double cpuS = cpuSecondsSoFar() - before, grown = growth(some);
    if (some < rows && cpuS < kMinCpuS) {
      fewerS = cpuS, fewer = grown;
      continue;
    }
    const double all = static_cast<double>(rows) / static_cast<double>(some);
    const double slope =
        grown > fewer && cpuS > fewerS ? (cpuS - fewerS) / (grown - fewer) : cpuS / grown;
    return {memory.before() + all * (memory.peak() - memory.before()), startS,
            cpuS + slope * (growth(rows) - grown), 1.0 / all,
            some == rows || fewer > 0.0};  // the slope needs two sizes
  }
}

void printCost(const Cost& cost, const CostOptions& options) {
  const double memoryMiB = cost.memoryBytes / 0x1p20, cpuS = cost.setupCpuS + cost.workCpuS;
  if (options.json) {
    const Json json{{"tool", runningTool()},         {"memory_MiB", memoryMiB}, {"cpu_s", cpuS},
                    {"setup_cpu_s", cost.setupCpuS}, {"probed", cost.probed},   {"sure", cost.sure},
                    {"threads", threadsInUse()}};
    return print(jsonText(json, 2) + "\n");
  }
  char text[240], part[32];
  std::snprintf(part, sizeof part, cost.probed < 1.0 ? "%.2g %%" : "all", 100.0 * cost.probed);
  std::snprintf(text, sizeof text,
                ": %s %.0f MiB of memory and %.3g CPU seconds, %.3g of them before the work "
                "that shards share out; from %s of it%s\n",
                cost.sure ? "about" : "roughly", memoryMiB, cpuS, cost.setupCpuS, part,
                cost.sure ? "" : ", which is too little to be sure of");
  print(runningTool() + text);
}

}  // namespace bnvpl
