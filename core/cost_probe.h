// Where a work is begun only to know what all of it costs: long preparations do a part of theirs,
// and tell what the rest would take.
#pragma once

#include <any>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <functional>
#include <utility>

namespace bnvpl {

class CostProbe {
 public:
  // `cpuS`: CPU seconds of this process so far.
  explicit CostProbe(std::function<double()> cpuS) : cpuS_(std::move(cpuS)) {}

  // What else the preparations, and the units, would have taken.
  double skippedCpuS() const { return skippedCpuS_; }
  // What preparations made, for the same work begun again.
  std::any kept;
  // Pixels of the film that is asked for; the one at hand may be smaller.
  uint64_t pixels = 0;
  // The part of the units that is being done; 1 where all of it is in shards that stay apart.
  double share = 1.0;
  // How often what the units take will be counted.
  double repeats = 1.0;
  // Neighbouring units share what is made once for each: of `around` such things that one unit
  // needs, its own included, the part that it would make if all units were done.
  double partOfShared(double around) const {
    return share / (1.0 - std::pow(1.0 - share, around)) / repeats;
  }

  // The same of one unit on one thread, by that thread's CPU time.
  class [[nodiscard]] Unit {
   public:
    Unit(CostProbe* probe, double times)
        : probe_(times != 1.0 ? probe : nullptr), times_(times), beforeS_(probe_ ? threadS() : 0) {}
    Unit(const Unit&) = delete;
    Unit& operator=(const Unit&) = delete;
    ~Unit() {
      if (probe_) probe_->skippedCpuS_ += (times_ - 1.0) * (threadS() - beforeS_);
    }

   private:
    static double threadS() {
      timespec t{};
      ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
      return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
    }
    CostProbe* probe_;
    double times_, beforeS_;
  };
  // While it lives a part is done of what would take `times` as long. Null: no probe.
  class [[nodiscard]] Part {
   public:
    Part(CostProbe* probe, double times) : probe_(probe), times_(times) {
      if (probe_) beforeS_ = probe_->cpuS_();
    }
    Part(const Part&) = delete;
    Part& operator=(const Part&) = delete;
    ~Part() {
      if (probe_) probe_->skippedCpuS_ += (times_ - 1.0) * (probe_->cpuS_() - beforeS_);
    }

   private:
    CostProbe* probe_;
    double times_, beforeS_ = 0.0;
  };

 private:
  std::function<double()> cpuS_;
  std::atomic<double> skippedCpuS_{0.0};
};

// Of `count` units that a preparation wants, how many to do: all, unless a probe has few do.
inline uint64_t unitsToTry(const CostProbe* probe, uint64_t count, uint64_t few) {
  return probe && count > few ? few : count;
}

}  // namespace bnvpl
