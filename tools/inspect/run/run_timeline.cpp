#include "tools/inspect/run/run_timeline.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/common/stage/output_kind.h"
#include "tools/inspect/append_text.h"
#include "tools/inspect/run/run_report.h"

namespace bnvpl {
namespace {

// Dimensions in pixels.
constexpr double kWidth = 1200, kLeft = 130, kRight = 20, kTop = 44, kBottom = 34;
constexpr double kMaxHeight = 900, kRowMost = 16, kRowLeast = 1, kHostGap = 4, kFont = 11;
constexpr double kPlotWidth = kWidth - kLeft - kRight;

// Colours of the stages in order. A merge follows its stage and has a lighter tone of its colour.
constexpr std::array kColours{"#4477aa", "#a3bddb", "#228833", "#cc9933", "#ebd9a6",
                              "#aa3377", "#dba3c4", "#66ccee", "#777777"};

struct Bar {
  const TaskAttempt* attempt;
  double startS, endS;
  size_t lane = 0;  // lane within its host
};

struct Host {
  std::vector<Bar> bars;
  size_t lanes = 0;
};

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += c;
  }
  return out;
}

// Puts each bar into the first lane that is free when it begins.
void assignLanes(Host& host) {
  std::ranges::stable_sort(host.bars, {}, [](const Bar& b) { return b.startS; });
  std::set<size_t> free;
  std::multimap<double, size_t> busy;  // end in seconds -> lane
  for (Bar& bar : host.bars) {
    while (!busy.empty() && busy.begin()->first <= bar.startS) {
      free.insert(busy.begin()->second);
      busy.erase(busy.begin());
    }
    if (free.empty()) free.insert(host.lanes++);
    bar.lane = *free.begin();
    free.erase(free.begin());
    busy.emplace(bar.endS, bar.lane);
  }
}

double endOfRun(const RunRecords& run) {
  double endS = 0.0;
  for (const TaskAttempt& a : run.attempts) endS = std::max(endS, a.endS.value_or(a.startS));
  return endS;
}

// The latest time until which an attempt without an end may have run.
double lastSeen(const std::vector<TaskAttempt>& attempts, size_t i, double endOfRunS) {
  if (i + 1 == attempts.size() || attempts[i + 1].task != attempts[i].task) return endOfRunS;
  return std::max(attempts[i].startS, attempts[i + 1].startS);
}

std::map<std::string, Host> hostsOf(const RunRecords& run) {
  std::map<std::string, Host> hosts;
  const double endS = endOfRun(run);
  for (size_t i = 0; i < run.attempts.size(); ++i) {
    const TaskAttempt& a = run.attempts[i];
    hosts[a.host].bars.push_back({&a, a.startS, a.endS.value_or(lastSeen(run.attempts, i, endS))});
  }
  for (auto& [name, host] : hosts) assignLanes(host);
  return hosts;
}

// The smallest step of 1, 2 or 5 times a power of ten that divides `spanS` into at most ten.
double tickStep(double spanS) {
  const double power = std::pow(10.0, std::floor(std::log10(std::max(spanS, 1e-3) / 10.0)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (spanS <= 10.0 * factor * power) return factor * power;
  }
  return 10.0 * power;
}

class Picture {
 public:
  Picture(const RunRecords& run, double startS, double spanS)
      : startS_(startS), scale_(kPlotWidth / std::max(spanS, 1e-3)), spanS_(spanS) {
    for (const std::string& stage : stagesInOrder(run))
      colours_.emplace(stage, kColours[std::min(colours_.size(), kColours.size() - 1)]);
    legend(stagesInOrder(run));
  }

  void host(const std::string& name, const Host& host, double rowHeight) {
    const double height = rowHeight * static_cast<double>(host.lanes);
    append(body_, "<rect class=\"host\" x=\"%.0f\" y=\"%.2f\" width=\"%.0f\" height=\"%.2f\"/>\n",
           kLeft, y_, kPlotWidth, height);
    text(kLeft - 6, y_ + 0.5 * height + 0.35 * kFont, "end", name.substr(0, 18));
    for (const Bar& each : host.bars) bar(each, rowHeight);
    y_ += height + kHostGap;
  }

  std::string finish() {
    ticks();
    std::string svg;
    append(svg,
           "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"%.0f\" "
           "font-family=\"sans-serif\" font-size=\"%.0f\">\n",
           kWidth, y_ + kBottom, kFont);
    svg += kSvgMark;
    svg +=
        "width=\"6\" height=\"6\" patternUnits=\"userSpaceOnUse\" "
        "patternTransform=\"rotate(45)\"><rect width=\"3\" height=\"6\" fill=\"#ffffff\" "
        "fill-opacity=\"0.7\"/></pattern></defs>\n"
        "<style>.host{fill:#f2f3f5} .failed{stroke:#d62222;stroke-width:1.5} "
        ".tick{stroke:#c4c8cd}</style>\n"
        "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n";
    return svg + body_ + "</svg>\n";
  }

 private:
  double x(double s) const { return kLeft + (s - startS_) * scale_; }

  void text(double x, double y, const char* anchor, const std::string& words) {
    append(body_, "<text x=\"%.2f\" y=\"%.2f\" text-anchor=\"%s\">", x, y, anchor);
    body_ += escaped(words) + "</text>\n";
  }

  void rectangle(const Bar& bar, double rowHeight, const char* more) {
    append(body_, "<rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" %s", x(bar.startS),
           y_ + rowHeight * static_cast<double>(bar.lane),
           std::max(0.5, (bar.endS - bar.startS) * scale_), 0.9 * rowHeight, more);
  }

  void bar(const Bar& bar, double rowHeight) {
    const TaskAttempt& a = *bar.attempt;
    const bool failed = !a.done();
    rectangle(bar, rowHeight, failed ? "class=\"failed\" " : "class=\"done\" ");
    append(body_, "fill=\"%s\"><title>", colours_.at(a.stage).c_str());
    body_ += escaped(a.task);
    append(body_, ", attempt %u%s: %.1f s, ", a.number, a.resumed ? ", resumed" : "",
           bar.endS - bar.startS);
    if (a.exit)
      append(body_, "exit code %d", *a.exit);
    else
      body_ += "no end";
    body_ += "</title></rect>\n";
    if (!a.endS) {
      rectangle(bar, rowHeight, "fill=\"url(#lost)\"");
      body_ += "/>\n";
    }
  }

  void legend(const std::vector<std::string>& stages) {
    double at = kLeft;
    for (const std::string& stage : stages) {
      append(body_, "<rect x=\"%.0f\" y=\"10\" width=\"10\" height=\"10\" fill=\"%s\"/>\n", at,
             colours_.at(stage).c_str());
      text(at + 14, 19, "start", stage);
      at += 30 + 0.62 * kFont * static_cast<double>(stage.size());
    }
  }

  void ticks() {
    const double step = tickStep(spanS_);
    for (int i = 0; i * step <= spanS_; ++i) {
      const double at = x(startS_ + i * step);
      append(body_, "<line class=\"tick\" x1=\"%.2f\" y1=\"%.2f\" x2=\"%.2f\" y2=\"%.2f\"/>\n", at,
             kTop - 6, at, y_ + 4);
      char label[32];
      std::snprintf(label, sizeof label, "%g s", i * step);
      text(at, y_ + 18, "middle", label);
    }
  }

  double startS_, scale_, spanS_, y_ = kTop;
  std::map<std::string, std::string> colours_;
  std::string body_;
};

}  // namespace

std::string timelineSvg(const RunRecords& run) {
  double startS = 1e300;
  for (const TaskAttempt& a : run.attempts) startS = std::min(startS, a.startS);
  const std::map<std::string, Host> hosts = hostsOf(run);
  size_t lanes = 0;
  for (const auto& [name, host] : hosts) lanes += host.lanes;
  const double rowHeight = std::clamp(kMaxHeight / static_cast<double>(lanes), kRowLeast, kRowMost);
  Picture picture(run, startS, endOfRun(run) - startS);
  for (const auto& [name, host] : hosts) picture.host(name, host, rowHeight);
  return picture.finish();
}

}  // namespace bnvpl
