// Progress with an estimate of the time that is left: one rewritten line on a terminal, elsewhere
// an occasional plain line in the tool's name.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

#include "core/progress.h"
#include "tools/common/time_left.h"

namespace bnvpl {

// "47 s", "2 min 05 s", "1 h 46 min". Negative counts as 0.
std::string durationText(double seconds);

// "samples 12M of 40M (30 %), 2 min 05 s left", without the time where it is not known yet. Without
// a total, 0, it ends in the time since the start: "samples 12M in 34 s".
std::string progressText(const std::string& what, uint64_t done, uint64_t total, double elapsedS,
                         std::optional<double> leftS);

class ProgressMeter {
 public:
  // `what` names the work ("photons"), `total` its size in the units passed to add().
  ProgressMeter(std::string what, uint64_t total, bool quiet);
  ~ProgressMeter();  // erases the line on a terminal

  void add(uint64_t done);  // from any thread
  // Preparations are shown under their own names; their time is not the main work's.
  ProgressFn callback() {
    return {[this](uint64_t done) { add(done); },
            [this](std::string_view what, uint64_t total) { beginPhase(what, total); },
            [this] { endPhase(); }};
  }

 private:
  struct Work {
    std::string what;
    uint64_t total;
    double startS;  // later by the time that its preparations took
    TimeLeft left = {};
  };
  void beginPhase(std::string_view what, uint64_t total);
  void endPhase();
  void print(double nowS, uint64_t done) const;

  Work work_;
  Work main_{};  // what goes on after the phase
  uint64_t mainDone_ = 0;
  bool quiet_, terminal_;
  std::atomic<uint64_t> done_{0};
  std::mutex mutex_;
  double nextReportS_ = 0.0, nextPrintS_;
};

}  // namespace bnvpl
