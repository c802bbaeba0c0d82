// --estimate runs a part of the work to predict the cost of all of it. A CostTrial tells long
// preparations that a part of them is enough, and counts the CPU time of the rest.
#pragma once

#include <any>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <functional>
#include <utility>

namespace bnvpl {

class CostTrial {
 public:
  // `cpuS`: CPU seconds of this process so far.
  explicit CostTrial(std::function<double()> cpuS) : cpuS_(std::move(cpuS)) {}

  // CPU time that preparations and units left out would have taken.
  double skippedCpuS() const { return skippedCpuS_; }
  // Results of the preparations, kept for the next part of the same work.
  std::any kept;
  // Pixels of the whole film; a trial may render a smaller one.
  uint64_t pixels = 0;
  // Share of the units that this part does; 1 if the shards of the work share no units.
  double share = 1.0;
  // How often the time of a unit will count.
  double repeats = 1.0;
  // Units share results with their neighbours: each needs `around` of them, its own included, and
  // computes those that no other unit has yet. Returns the ratio of the number that a unit computes
  // when all units run to the number that it computes in this part.
  double partOfShared(double around) const {
    return share / (1.0 - std::pow(1.0 - share, around)) / repeats;
  }

  // Counts, for as long as it lives, one unit on one thread that stands for `times` such units.
  class [[nodiscard]] Unit {
   public:
    Unit(CostTrial* trial, double times)
        : trial_(times != 1.0 ? trial : nullptr), times_(times), beforeS_(trial_ ? threadS() : 0) {}
    Unit(const Unit&) = delete;
    Unit& operator=(const Unit&) = delete;
    ~Unit() {
      if (trial_) trial_->skippedCpuS_ += (times_ - 1.0) * (threadS() - beforeS_);
    }

   private:
    static double threadS() {
      timespec t{};
      ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
      return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
    }
    CostTrial* trial_;
    double times_, beforeS_;
  };
  // Counts, for as long as it lives, a part of work that would take `times` as long. `trial` may be
  // null.
  class [[nodiscard]] Part {
   public:
    Part(CostTrial* trial, double times) : trial_(trial), times_(times) {
      if (trial_) beforeS_ = trial_->cpuS_();
    }
    Part(const Part&) = delete;
    Part& operator=(const Part&) = delete;
    ~Part() {
      if (trial_) trial_->skippedCpuS_ += (times_ - 1.0) * (trial_->cpuS_() - beforeS_);
    }

   private:
    CostTrial* trial_;
    double times_, beforeS_ = 0.0;
  };

 private:
  std::function<double()> cpuS_;
  std::atomic<double> skippedCpuS_{0.0};
};

// The number of units that a preparation does: all `count` of them, or at most `few` for a trial.
inline uint64_t unitsToTry(const CostTrial* trial, uint64_t count, uint64_t few) {
  return trial && count > few ? few : count;
}

}  // namespace bnvpl
