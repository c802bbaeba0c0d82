#include "tools/common/progress_meter.h"

#include <unistd.h>

#include <cstdio>

#include "tools/common/clock.h"
#include "tools/common/run_tool.h"

namespace bnvpl {

namespace {
constexpr double kTerminalIntervalS = 0.2;
constexpr double kLogIntervalS = 10.0;  // a build log wants a sign of life, not a film
}  // namespace

ProgressMeter::ProgressMeter(std::string what, uint64_t total, bool quiet)
    : what_(std::move(what)),
      total_(total),
      quiet_(quiet),
      terminal_(::isatty(STDERR_FILENO) == 1),
      startS_(nowS()),
      nextPrintS_(startS_ + (terminal_ ? kTerminalIntervalS : kLogIntervalS)) {}

ProgressMeter::~ProgressMeter() {
  if (!quiet_ && terminal_) std::fprintf(stderr, "\r\x1b[K");
}

void ProgressMeter::add(uint64_t done) {
  const uint64_t sum = done_.fetch_add(done, std::memory_order_relaxed) + done;
  if (quiet_) return;
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock.owns_lock()) return;  // somebody else is printing
  const double now = nowS();
  if (now < nextPrintS_) return;
  nextPrintS_ = now + (terminal_ ? kTerminalIntervalS : kLogIntervalS);
  print(now - startS_, sum);
}

void ProgressMeter::print(double elapsedS, uint64_t done) const {
  const double share = total_ > 0 ? static_cast<double>(done) / static_cast<double>(total_) : 0.0;
  const double leftS = share > 0.0 ? elapsedS * (1.0 - share) / share : 0.0;
  std::fprintf(stderr, "%s%s %s of %s (%.0f %%), %.0f s left%s", terminal_ ? "\r\x1b[K" : "",
               what_.c_str(), formatSi(static_cast<double>(done)).c_str(),
               formatSi(static_cast<double>(total_)).c_str(), 100.0 * share, leftS,
               terminal_ ? "" : "\n");
  std::fflush(stderr);
}

}  // namespace bnvpl
