#include "tools/common/run/progress_meter.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "tools/common/files/json_text.h"
#include "tools/common/files/standard_streams.h"
#include "tools/common/process/clock.h"
#include "tools/common/run/run_tool.h"

namespace bnvpl {

namespace {
constexpr double kTerminalIntervalS = 0.2;
constexpr double kLogIntervalS = 10.0;  // few lines for build logs
constexpr double kJsonIntervalS = 0.5;
constexpr double kReportIntervalS = 0.2;
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

std::string progressText(const std::string& what, uint64_t done, uint64_t total, double elapsedS,
                         const ProgressNote& note) {
  std::string known = note.leftS ? ", " + durationText(*note.leftS) + " left" : "";
  if (note.error) {
    char error[32];
    std::snprintf(error, sizeof error, ", error %.2g", *note.error);
    known += error;
  }
  if (total == 0)
    return what + " " + formatSi(static_cast<double>(done)) + " in " + durationText(elapsedS) +
           known;
  const double share = static_cast<double>(done) / static_cast<double>(total);
  char percent[32];
  std::snprintf(percent, sizeof percent, " (%.0f %%)", std::floor(100.0 * share));
  return what + " " + formatSi(static_cast<double>(done)) + " of " +
         formatSi(static_cast<double>(total)) + percent + known;
}

std::string progressJson(const std::string& stage, const std::string& phase, uint64_t done,
                         uint64_t total, double elapsedS, const ProgressNote& note) {
  const auto rounded = [](double seconds) { return std::round(1e3 * seconds) / 1e3; };
  Json json{{"stage", stage}, {"phase", phase}, {"done", done}, {"total", nullptr}};
  json["elapsed_s"] = rounded(elapsedS);
  json["left_s"] = nullptr;
  if (total > 0) json["total"] = total;
  if (note.leftS) json["left_s"] = rounded(*note.leftS);
  if (note.error) json["error"] = *note.error;
  return jsonText(json);
}

ProgressMeter::ProgressMeter(std::string what, uint64_t total, ProgressStyle style)
    : work_{std::move(what), total, nowS()},
      style_(style),
      terminal_(::isatty(STDERR_FILENO) == 1),
      nextPrintS_(work_.startS + intervalS()) {}

ProgressMeter::~ProgressMeter() {
  eraseProgress();
  if (style_ == ProgressStyle::JsonLines) print(nowS(), done_);
}

double ProgressMeter::intervalS() const {
  if (style_ == ProgressStyle::JsonLines) return kJsonIntervalS;
  return terminal_ ? kTerminalIntervalS : kLogIntervalS;
}

void ProgressMeter::add(uint64_t done) {
  done_.fetch_add(done, std::memory_order_relaxed);
  if (style_ == ProgressStyle::Silent) return;
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock.owns_lock()) return;  // another thread is printing
  const double now = nowS();
  if (now < nextReportS_) return;
  nextReportS_ = now + kReportIntervalS;
  const uint64_t sum = done_;
  work_.left.report(now, sum);
  if (now < nextPrintS_) return;
  nextPrintS_ = now + intervalS();
  print(now, sum);
}

void ProgressMeter::beginPhase(std::string_view what, uint64_t total) {
  const std::scoped_lock lock(mutex_);
  main_ = std::exchange(work_, {std::string(what), total, nowS()});
  mainDone_ = done_.exchange(0);
  work_.left.report(work_.startS, 0);
  nextReportS_ = 0.0;
}

void ProgressMeter::endPhase() {
  const std::scoped_lock lock(mutex_);
  if (style_ == ProgressStyle::JsonLines) print(nowS(), done_);
  const double tookS = nowS() - work_.startS;
  work_ = std::move(main_);
  work_.startS += tookS;
  work_.left.skip(tookS);
  done_ = mainDone_;
  nextReportS_ = 0.0;
}

void ProgressMeter::tell(const ProgressNote& note) {
  const std::scoped_lock lock(mutex_);
  work_.note = note;
  work_.notedS = nowS();
}

void ProgressMeter::print(double nowS, uint64_t done) const {
  const double elapsedS = nowS - work_.startS;
  ProgressNote note = work_.note;
  if (note.leftS)
    note.leftS = std::max(0.0, *note.leftS - (nowS - work_.notedS));
  else
    note.leftS = work_.left.seconds(work_.total);
  if (style_ == ProgressStyle::JsonLines) {
    ErrorLine().add(progressJson(runningTool(), work_.what, done, work_.total, elapsedS, note));
    return;
  }
  const std::string text = progressText(work_.what, done, work_.total, elapsedS, note);
  if (terminal_)
    showProgress(text);
  else
    ErrorLine().add(runningTool()).add(": ").add(text);
}

}  // namespace bnvpl
