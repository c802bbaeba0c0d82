// Progress with an estimate of the time that is left: one rewritten line on a terminal, elsewhere
// an occasional plain line in the tool's name.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>

#include "core/progress.h"

namespace bnvpl {

// "47 s", "2 min 05 s", "1 h 46 min". Negative counts as 0.
std::string durationText(double seconds);

// "samples 12M of 40M (30 %), 2 min 05 s left", without the time as long as too little is done to
// tell it: under 2 % within 10 s. Of a total that nobody knows, 0: "samples 12M in 34 s".
std::string progressText(const std::string& what, uint64_t done, uint64_t total, double elapsedS);

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
  };
  void beginPhase(std::string_view what, uint64_t total);
  void endPhase();
  void print(double elapsedS, uint64_t done) const;

  Work work_;
  Work main_{};  // what goes on after the phase
  uint64_t mainDone_ = 0;
  bool quiet_, terminal_;
  std::atomic<uint64_t> done_{0};
  std::mutex mutex_;
  double nextPrintS_;
};

}  // namespace bnvpl
