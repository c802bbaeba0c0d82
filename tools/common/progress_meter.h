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

// "samples 12M of 40M (30 %), 2 min 05 s left", without the time while nothing is done.
std::string progressText(const std::string& what, uint64_t done, uint64_t total, double elapsedS);

class ProgressMeter {
 public:
  // `what` names the work ("photons"), `total` its size in the units passed to add().
  ProgressMeter(std::string what, uint64_t total, bool quiet);
  ~ProgressMeter();  // erases the line on a terminal

  void add(uint64_t done);  // from any thread
  ProgressFn callback() {
    return [this](uint64_t done) { add(done); };
  }

 private:
  void print(double elapsedS, uint64_t done) const;

  std::string what_;
  uint64_t total_;
  bool quiet_, terminal_;
  double startS_;
  std::atomic<uint64_t> done_{0};
  std::mutex mutex_;
  double nextPrintS_;
};

}  // namespace bnvpl
