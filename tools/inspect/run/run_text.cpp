// The report of `vpl-inspect run` for people.
#include <algorithm>
#include <ctime>

#include "tools/inspect/append_text.h"
#include "tools/inspect/run/run_report.h"

namespace bnvpl {
namespace {

constexpr size_t kMaxNamed = 10;  // max number of unfinished tasks to list

std::string textOf(const Json& json, const char* key) { return json[key].get<std::string>(); }
size_t count(const Json& json, const char* key) { return json[key].get<size_t>(); }
double number(const Json& json, const char* key) { return json[key].get<double>(); }

// 95.3 s, 12.5 min, 3.2 h
std::string duration(double s) {
  char text[32];
  if (s < 600.0)
    std::snprintf(text, sizeof text, "%.1f s", s);
  else if (s < 36000.0)
    std::snprintf(text, sizeof text, "%.1f min", s / 60.0);
  else
    std::snprintf(text, sizeof text, "%.1f h", s / 3600.0);
  return text;
}

std::string cpuTime(const Json& json) { return duration(3600.0 * number(json, "cpu_h")); }

std::string dateOf(double s) {
  const auto seconds = static_cast<std::time_t>(s);
  std::tm parts{};
  char text[64] = "";
  if (gmtime_r(&seconds, &parts) != nullptr)
    std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S UTC", &parts);
  return text;
}

int widest(const Json& rows, const char* key, size_t width) {
  for (const Json& row : rows) width = std::max(width, textOf(row, key).size());
  return static_cast<int>(width);
}

void appendStages(std::string& text, const Json& stages) {
  const int width = widest(stages, "stage", 5);
  append(text, "%-*s %7s %8s %7s %10s %12s %10s %11s\n", width, "stage", "tasks", "attempts",
         "resumed", "wall", "longest task", "CPU time", "peak memory");
  for (const Json& s : stages) {
    append(text, "%-*s %7zu %8zu %7zu %10s %12s %10s %7.0f MiB\n", width,
           textOf(s, "stage").c_str(), count(s, "tasks"), count(s, "attempts"), count(s, "resumed"),
           duration(number(s, "wall_s")).c_str(), duration(number(s, "longest_s")).c_str(),
           cpuTime(s).c_str(), number(s, "peak_memory_MiB"));
  }
}

void appendHosts(std::string& text, const Json& hosts) {
  const int width = widest(hosts, "host", 5);
  append(text, "%-*s %8s %7s %10s %10s %11s\n", width, "host", "attempts", "no end", "busy",
         "CPU time", "peak memory");
  for (const Json& h : hosts) {
    append(text, "%-*s %8zu %7zu %10s %10s %7.0f MiB\n", width, textOf(h, "host").c_str(),
           count(h, "attempts"), count(h, "without_end"), duration(number(h, "busy_s")).c_str(),
           cpuTime(h).c_str(), number(h, "peak_memory_MiB"));
  }
}

void appendUnfinished(std::string& text, const Json& tasks) {
  for (size_t i = 0; i < tasks.size(); ++i) {
    if (i == kMaxNamed) {
      append(text, "not done: %zu more tasks\n", tasks.size() - i);
      return;
    }
    append(text, "not done: %s, ", textOf(tasks[i], "task").c_str());
    if (tasks[i]["exit"].is_null())
      text += "which runs, or was killed with its machine\n";
    else
      append(text, "exit code %d\n", tasks[i]["exit"].get<int>());
  }
}

void appendCriticalPath(std::string& text, const Json& path) {
  append(text, "critical path: %s:", duration(number(path, "wall_s")).c_str());
  std::string separator = " ";
  for (const Json& step : path["tasks"]) {
    text += separator + textOf(step, "task") + " " + duration(number(step, "wall_s"));
    separator = ", ";
  }
  text += "\n";
}

}  // namespace

std::string runText(const Json& d) {
  std::string text;
  append(text, "%zu tasks in %zu attempts, %zu of them resumed and %zu without an end\n",
         count(d, "tasks"), count(d, "attempts"), count(d, "resumed"), count(d, "without_end"));
  append(text, "from %s on: %s, CPU time %s\n", dateOf(number(d, "start_s")).c_str(),
         duration(number(d, "wall_s")).c_str(), cpuTime(d).c_str());
  text += "\n";
  appendStages(text, d["stages"]);
  text += "\n";
  appendHosts(text, d["hosts"]);
  text += "\n";
  appendUnfinished(text, d["unfinished"]);
  appendCriticalPath(text, d["critical_path"]);
  return text;
}

}  // namespace bnvpl
