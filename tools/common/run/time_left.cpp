#include "tools/common/run/time_left.h"

#include <algorithm>

namespace bnvpl {

namespace {
constexpr double kEnoughShare = 0.02, kShortS = 2.0, kEnoughS = 10.0;
}  // namespace

void TimeLeft::report(double timeS, uint64_t done) {
  if (!begun_) {
    begun_ = true;
    startS_ = timeS;
    first_ = last_ = done;
  }
  const double before = elapsedS_;
  elapsedS_ = std::max(before, timeS - startS_);
  // The integral of t over an interval is half its length times the sum of its ends.
  weighted_ += static_cast<double>(done - last_) * (before + elapsedS_);
  last_ = done;
}

std::optional<double> TimeLeft::seconds(uint64_t total) const {
  const auto units = static_cast<double>(last_ - first_);
  const bool enough = elapsedS_ >= kEnoughS ||
                      (elapsedS_ >= kShortS && units >= kEnoughShare * static_cast<double>(total));
  if (!enough || units == 0.0 || total <= last_) return {};
  const double speed = weighted_ / (elapsedS_ * elapsedS_);
  return static_cast<double>(total - last_) / speed;
}

}  // namespace bnvpl
