#include "tools/common/progress_meter.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "tools/common/clock.h"
#include "tools/common/run_tool.h"

namespace bnvpl {

namespace {
constexpr double kTerminalIntervalS = 0.2;
constexpr double kLogIntervalS = 10.0;  // a build log wants a sign of life, not a film
// The first units of a work may take far longer than the others: from these on, what is left is
// extrapolated.
constexpr double kTellingShare = 0.02, kTellingS = 10.0;
}  // namespace

std::string durationText(double seconds) {
  constexpr double kLongestS = 3.6e9;  // a million hours
  const auto s = static_cast<uint64_t>(std::llround(std::clamp(seconds, 0.0, kLongestS)));
  char text[48];
  if (s < 60) return std::to_string(s) + " s";
  if (s < 3600) {
    std::snprintf(text, sizeof text, "%u min %02u s", unsigned(s / 60), unsigned(s % 60));
  } else {
    const uint64_t min = (s + 30) / 60;
    std::snprintf(text, sizeof text, "%u h %02u min", unsigned(min / 60), unsigned(min % 60));
  }
  return text;
}

std::string progressText(const std::string& what, uint64_t done, uint64_t total, double elapsedS) {
  if (total == 0)
    return what + " " + formatSi(static_cast<double>(done)) + " in " + durationText(elapsedS);
  const double share = static_cast<double>(done) / static_cast<double>(total);
  char percent[32];
  std::snprintf(percent, sizeof percent, " (%.0f %%)", 100.0 * share);
  std::string text = what + " " + formatSi(static_cast<double>(done)) + " of " +
                     formatSi(static_cast<double>(total)) + percent;
  if (share >= kTellingShare || (share > 0.0 && elapsedS >= kTellingS))
    text += ", " + durationText(elapsedS * (1.0 - share) / share) + " left";
  return text;
}

ProgressMeter::ProgressMeter(std::string what, uint64_t total, bool quiet)
    : work_{std::move(what), total, nowS()},
      quiet_(quiet),
      terminal_(::isatty(STDERR_FILENO) == 1),
      nextPrintS_(work_.startS + (terminal_ ? kTerminalIntervalS : kLogIntervalS)) {}

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
  print(now - work_.startS, sum);
}

void ProgressMeter::beginPhase(std::string_view what, uint64_t total) {
  const std::scoped_lock lock(mutex_);
  main_ = std::exchange(work_, {std::string(what), total, nowS()});
  mainDone_ = done_.exchange(0);
}

void ProgressMeter::endPhase() {
  const std::scoped_lock lock(mutex_);
  main_.startS += nowS() - work_.startS;
  work_ = std::move(main_);
  done_ = mainDone_;
}

void ProgressMeter::print(double elapsedS, uint64_t done) const {
  const std::string text = progressText(work_.what, done, work_.total, elapsedS);
  if (terminal_)
    std::fprintf(stderr, "\r\x1b[K%s", text.c_str());
  else
    std::fprintf(stderr, "%s: %s\n", runningTool().c_str(), text.c_str());
  std::fflush(stderr);
}

}  // namespace bnvpl
