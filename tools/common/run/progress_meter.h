// Progress with an estimate of the time that is left: one rewritten line on a terminal, otherwise
// an occasional plain line that begins with the tool's name. --progress json makes it one JSON
// object a line instead.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

#include "core/progress.h"
#include "tools/common/run/time_left.h"

namespace bnvpl {

// "47 s", "2 min 05 s", "1 h 46 min". Negative counts as 0.
std::string durationText(double seconds);

// "samples 12M of 40M (30 %), 2 min 05 s left, error 0.031", without what is unknown. If `total` is
// 0, the text has the elapsed time instead: "samples 12M in 34 s".
std::string progressText(const std::string& what, uint64_t done, uint64_t total, double elapsedS,
                         const ProgressNote& note);

// {"stage": "vpl-render", "phase": "samples", "done": 3, "total": 9, "elapsed_s": 1.5, "left_s":
// 3}, with null for what is unknown, such as a `total` of 0. "error" is there once it is known.
std::string progressJson(const std::string& stage, const std::string& phase, uint64_t done,
                         uint64_t total, double elapsedS, const ProgressNote& note);

enum class ProgressStyle { Silent, Lines, JsonLines };

class ProgressMeter {
 public:
  // `what` names the work ("photons"), `total` its size in the units passed to add().
  ProgressMeter(std::string what, uint64_t total, ProgressStyle style);
  ~ProgressMeter();  // erases the line on a terminal; prints the last object of JSON

  void add(uint64_t done);  // from any thread
  // Preparations are shown under their own names; their time does not count for the main work.
  ProgressFn callback() {
    return {[this](uint64_t done) { add(done); },
            [this](std::string_view what, uint64_t total) { beginPhase(what, total); },
            [this] { endPhase(); }, [this](const ProgressNote& note) { tell(note); }};
  }

 private:
  struct Work {
    std::string what;
    uint64_t total;
    double startS;  // moved later by the time of its preparations
    TimeLeft left = {};
    ProgressNote note = {};
    double notedS = 0.0;
  };
  void beginPhase(std::string_view what, uint64_t total);
  void endPhase();
  void tell(const ProgressNote& note);
  void print(double nowS, uint64_t done) const;
  double intervalS() const;

  Work work_;
  Work main_{};  // the work that continues after the phase
  uint64_t mainDone_ = 0;
  ProgressStyle style_;
  bool terminal_;
  std::atomic<uint64_t> done_{0};
  std::mutex mutex_;
  double nextReportS_ = 0.0, nextPrintS_;
};

}  // namespace bnvpl
