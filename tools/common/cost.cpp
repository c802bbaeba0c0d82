#include "tools/common/cost.h"

#include <sys/resource.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <fstream>

#include "tools/common/standard_streams.h"

namespace bnvpl {
namespace {

constexpr double kMinCpuS = 0.5;     // that a probe takes, where there is so much to do
constexpr double kMinUnits = 32.0;  // that it does: they differ
constexpr uint64_t kFirstRows = 1 << 17;

double bytesIn(const char* key) {  // of /proc/self/status: "VmHWM:     12345 kB"
  std::ifstream in("/proc/self/status");
  unsigned long long kib = 0;
  const std::string format = std::string(key) + ": %llu kB";
  for (std::string line; std::getline(in, line);) {
    if (std::sscanf(line.c_str(), format.c_str(), &kib) == 1) break;
  }
  return static_cast<double>(kib) * 1024.0;
}

struct Probe {
  double cpuS = 0.0, units = 0.0;
};

Probe probe(const std::function<void(const Resume&)>& part, const Shard& shard) {
  std::atomic<uint64_t> units{0};
  const ShardSink nowhere{[](std::string_view, uint64_t, std::string_view) {},
                          [](std::string_view, std::span<const int64_t>) {}};
  Resume resume;
  resume.shard = shard;
  resume.sink = &nowhere;
  resume.pause = [&] {  // asked once after each unit
    units.fetch_add(1, std::memory_order_relaxed);
    return false;
  };
  resume.save = [](const std::string&) {};
  const double before = cpuSecondsSoFar();
  part(resume);
  return {cpuSecondsSoFar() - before, static_cast<double>(units)};
}

// The middle one of so many parts, whose units are those of all over so many, rounded. Odd, since
// an image's tiles often come in rows of even numbers, of which a part would hold whole columns.
Shard middleOf(double parts) {
  const uint64_t of = static_cast<uint64_t>(parts) | 1;
  return {of / 2, of / 2 + 1, of};
}

}  // namespace

void addCostOptions(CLI::App& cli, CostOptions& options) {
  CLI::Option* estimate = cli.add_flag(
      "--estimate", options.estimate,
      "do a small part of the work, print what all of it will need, and write nothing");
  cli.add_flag("--json", options.json, "print that as JSON")->needs(estimate);
}

double cpuSecondsSoFar() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

MemoryWatch::MemoryWatch() : before_(bytesIn("VmRSS")) {
  std::ofstream("/proc/self/clear_refs") << "5\n";  // forget the peak
}

double MemoryWatch::peak() const { return bytesIn("VmHWM"); }

Cost Cost::ofShard(const std::optional<Shard>& shard) const {
  Cost cost = *this;
  if (shard) cost.workCpuS *= static_cast<double>(shard->parts()) / static_cast<double>(shard->of);
  return cost;
}

Cost costOfUnits(const std::function<void(const Resume&)>& part) {
  constexpr uint64_t kNone = uint64_t{1} << 40;  // no work has so many units
  const double startS = cpuSecondsSoFar();
  const double setupS = probe(part, {kNone - 1, kNone, kNone}).cpuS;
  // The first units may prepare what is not of the units: their cost is the slope between two
  // probes that had any.
  Probe fewer{setupS, 0.0};
  double fewerShare = 0.0;
  for (double parts = 4096.0;;) {
    const Shard shard = parts > 1.0 ? middleOf(parts) : Shard{};
    const Probe some = probe(part, shard);
    const double share = 1.0 / static_cast<double>(shard.of);
    const double cpuS = some.cpuS - setupS, enoughS = std::max(kMinCpuS, setupS);
    if (shard.whole() || (some.units >= kMinUnits && cpuS >= enoughS)) {
      const double workS = std::max(0.0, some.cpuS - fewer.cpuS) / (share - fewerShare);
      const double beforeS = std::max(setupS, some.cpuS - workS * share);
      return {bytesIn("VmHWM"), startS + beforeS, workS, share};
    }
    const double more = std::max(kMinUnits / std::max(some.units, 0.5),
                                 enoughS / std::max(cpuS, 0.01 * enoughS));
    if (some.units > 0.0) {
      fewer = some;
      fewerShare = share;
    }
    parts /= std::clamp(1.3 * more, 2.0, 64.0);
    if (parts < 3.0) parts = 1.0;
  }
}

Cost costOfRows(uint64_t rows, const std::function<void(uint64_t)>& part,
                const std::function<double(uint64_t)>& growth) {
  const double startS = cpuSecondsSoFar();
  for (uint64_t some = std::min(rows, kFirstRows);; some = std::min(rows, 4 * some)) {
    const MemoryWatch memory;
    const double before = cpuSecondsSoFar();
    part(some);
    const double cpuS = cpuSecondsSoFar() - before;
    if (some < rows && cpuS < kMinCpuS) continue;
    const double all = static_cast<double>(rows) / static_cast<double>(some);
    return {memory.before() + all * (memory.peak() - memory.before()), startS,
            cpuS * growth(rows) / growth(some), 1.0 / all};
  }
}

void printCost(const Cost& cost, const CostOptions& options) {
  const double memoryMiB = cost.memoryBytes / 0x1p20, cpuS = cost.setupCpuS + cost.workCpuS;
  if (options.json) {
    const Json json{{"tool", runningTool()}, {"memory_MiB", memoryMiB},
                    {"cpu_s", cpuS},         {"setup_cpu_s", cost.setupCpuS},
                    {"probed", cost.probed}, {"threads", threadsInUse()}};
    return print(jsonText(json, 2) + "\n");
  }
  char text[160];
  std::snprintf(text, sizeof text,
                ": about %.0f MiB of memory and %.3g CPU seconds, %.3g of them before the work "
                "that shards share out; from %.2g %% of it\n",
                memoryMiB, cpuS, cost.setupCpuS, 100.0 * cost.probed);
  print(runningTool() + text);
}

}  // namespace bnvpl
