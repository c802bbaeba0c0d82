// How long a work still takes, by its own speed so far.
#pragma once

#include <cstdint>
#include <optional>

namespace bnvpl {

// The clock runs from the first report on, so that what went before it - loading, or the units of a
// checkpoint - plays no part. The speed is a mean over the time since then in which a moment weighs
// in proportion to how late it is: it follows a work that becomes faster or slower, and does not
// jump.
//   speed = 2 / T^2 * integral of t * (units per second at t) dt over 0 <= t <= T
class TimeLeft {
 public:
  // `done` units in all, at a time in seconds. Neither ever falls.
  void report(double timeS, uint64_t done);
  // Work that something else interrupted for so long.
  void skip(double seconds) { startS_ += seconds; }
  // Seconds until `total` units are done. Nothing as long as too little is known: two seconds and
  // 2 % of all, or ten seconds.
  std::optional<double> seconds(uint64_t total) const;

 private:
  bool begun_ = false;
  double startS_ = 0.0, elapsedS_ = 0.0;
  uint64_t first_ = 0, last_ = 0;
  double weighted_ = 0.0;  // sum of units times the sum of the times before and after them
};

}  // namespace bnvpl
