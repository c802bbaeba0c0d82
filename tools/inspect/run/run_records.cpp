#include "tools/inspect/run/run_records.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/files.h"
#include "core/read_file.h"
#include "tools/common/run/run_tool.h"

namespace bnvpl {
namespace {

constexpr const char* kSuffix = ".task.json";
constexpr uintmax_t kMaxBytes = uintmax_t{1} << 24;
constexpr size_t kLongestName = 200;
constexpr double kMaxTimeS = 1e11;  // the year 5138
constexpr double kMaxS = 1e12, kMaxMiB = 1e12, kMaxAttempts = 1e6, kMaxExit = 255;

// The fields of one record. Every error names the file.
class Record {
 public:
  explicit Record(const fs::path& file) : file_(file) {
    if (!isRegularFile(file)) fail("is not a regular file");
    if (fs::file_size(file) > kMaxBytes) fail("is too large for a record");
    json_ = parseJson(readText(file));
    if (!json_.is_object()) fail("is no record of pipelines/record.py");
  }

  std::string name(const char* key) const {
    std::string text = optionalName(key);
    if (text.empty()) fail(std::string("'") + key + "' is missing or empty");
    return text;
  }
  std::string optionalName(const char* key) const {
    return json_.contains(key) ? nameIn(json_[key], key) : "";
  }
  std::set<std::string> names(const char* key) const {
    std::set<std::string> all;
    if (!json_.contains(key)) return all;
    if (!json_[key].is_array()) fail(std::string("'") + key + "' is no list");
    for (const Json& each : json_[key]) all.insert(nameIn(each, key));
    return all;
  }
  std::optional<double> optionalNumber(const char* key, double most) const {
    if (!json_.contains(key)) return {};
    const Json& value = json_[key];
    const double number = value.is_number() ? value.get<double>() : NAN;
    if (!(number >= 0.0 && number <= most))
      fail(std::string("'") + key + "' is no number that it can be");
    return number;
  }
  double number(const char* key, double most) const {
    const std::optional<double> value = optionalNumber(key, most);
    if (!value) fail(std::string("'") + key + "' is missing");
    return *value;
  }
  bool flag(const char* key) const {
    if (!json_.contains(key)) return false;
    if (!json_[key].is_boolean()) fail(std::string("'") + key + "' is neither true nor false");
    return json_[key].get<bool>();
  }
  [[noreturn]] void fail(const std::string& problem) const {
    throw InputError(file_, problem + "; remove it");
  }

 private:
  // Names are printed and must not hold control characters.
  std::string nameIn(const Json& value, const char* key) const {
    if (!value.is_string()) fail(std::string("'") + key + "' is no text");
    std::string text = value.get<std::string>();
    const bool printable = std::ranges::all_of(text, [](char c) { return c >= ' ' && c <= '~'; });
    if (!printable || text.size() > kLongestName)
      fail(std::string("'") + key + "' is not up to 200 printable characters of ASCII");
    return text;
  }

  fs::path file_;
  Json json_;
};

TaskAttempt attemptOf(const Record& record) {
  TaskAttempt a;
  a.task = record.name("task");
  a.stage = record.name("stage");
  a.host = record.name("host");
  a.job = record.optionalName("job");
  a.number = static_cast<unsigned>(record.number("attempt", kMaxAttempts));
  a.resumed = record.flag("resumed");
  a.startS = record.number("start_s", kMaxTimeS);
  a.endS = record.optionalNumber("end_s", kMaxTimeS);
  a.cpuS = record.optionalNumber("cpu_s", kMaxS);
  a.peakMemoryMiB = record.optionalNumber("peak_memory_MiB", kMaxMiB);
  if (const auto code = record.optionalNumber("exit", kMaxExit)) a.exit = static_cast<int>(*code);
  if (a.endS && *a.endS < a.startS) record.fail("ends before it starts");
  if (a.endS.has_value() != a.exit.has_value())
    record.fail("has one of 'end_s' and 'exit' without the other");
  return a;
}

std::vector<fs::path> recordFiles(const fs::path& folder) {
  std::error_code problem;
  std::vector<fs::path> files;
  for (fs::directory_iterator i(folder, problem), end; !problem && i != end; i.increment(problem)) {
    const std::string name = i->path().filename().string();
    if (name.ends_with(kSuffix) && !name.starts_with(".")) files.push_back(i->path());
  }
  if (problem)
    throw InputError(folder, "cannot be read as a folder: " + problem.message() +
                                 "; name the folder run of a pipeline's output");
  if (files.empty())
    throw InputError(folder, std::string("holds no *") + kSuffix +
                                 "; name the folder run of pipelines/slurm/submit.py, or of "
                                 "generate_ninja.py --record");
  std::ranges::sort(files);
  return files;
}

// The first of the ordered attempts of a task that belongs to the task's latest run.
using Attempts = std::vector<TaskAttempt>;
Attempts::iterator latestRun(Attempts::iterator begin, Attempts::iterator end) {
  Attempts::iterator first = begin;
  for (Attempts::iterator i = begin; i != end && i + 1 != end; ++i) {
    if (i->done()) first = i + 1;
  }
  return first;
}

}  // namespace

RunRecords readRunRecords(const fs::path& folder) {
  RunRecords run;
  Attempts all;
  for (const fs::path& file : recordFiles(folder)) {
    const Record record(file);
    all.push_back(attemptOf(record));
    run.after[all.back().stage].merge(record.names("after"));
  }
  std::ranges::stable_sort(all, {},
                           [](const TaskAttempt& a) { return std::tie(a.task, a.number); });
  for (auto begin = all.begin(); begin != all.end();) {
    const auto end =
        std::find_if(begin, all.end(), [&](const TaskAttempt& a) { return a.task != begin->task; });
    run.attempts.insert(run.attempts.end(), latestRun(begin, end), end);
    begin = end;
  }
  return run;
}

}  // namespace bnvpl
