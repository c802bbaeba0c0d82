// Estimates the time that a work still takes from its speed so far.
#pragma once

#include <cstdint>
#include <optional>

namespace bnvpl {

// Time counts from the first report, so that loading and the units of a checkpoint play no part.
// The speed is a mean over the time since then, with weights that grow linearly with time: it
// follows changes of speed, but smoothly.
//   speed = 2 / T^2 * integral of t * (units per second at t) dt over 0 <= t <= T
class TimeLeft {
 public:
  // `done` is the total number of units at time `timeS`, in seconds. Neither ever decreases.
  void report(double timeS, uint64_t done);
  // Excludes an interruption of the work.
  void skip(double seconds) { startS_ += seconds; }
  // Seconds until `total` units are done; none before two seconds and 2 % of the units, or ten
  // seconds, have passed.
  std::optional<double> seconds(uint64_t total) const;

 private:
  bool begun_ = false;
  double startS_ = 0.0, elapsedS_ = 0.0;
  uint64_t first_ = 0, last_ = 0;
  double weighted_ = 0.0;  // sum over reports: units times (time before + time after them)
};

}  // namespace bnvpl
