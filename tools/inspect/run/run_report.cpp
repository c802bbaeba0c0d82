#include "tools/inspect/run/run_report.h"

#include <algorithm>

namespace bnvpl {
namespace {

struct Task {
  std::string name;
  double startS = 0.0;
  std::optional<double> endS;  // latest end of an attempt
  bool done = false;
  std::optional<int> exit;  // the last attempt's; none: killed with its machine, or running
};

// Sums over attempts. Attempts without an end add neither busy time nor CPU time.
struct Use {
  size_t attempts = 0, resumed = 0, withoutEnd = 0;
  double startS = kNone, endS = 0.0, busyS = 0.0, cpuS = 0.0, peakMemoryMiB = 0.0;
  std::set<std::string> hosts;
  static constexpr double kNone = 1e300;

  void add(const TaskAttempt& a) {
    ++attempts;
    resumed += a.resumed;
    withoutEnd += !a.endS;
    startS = std::min(startS, a.startS);
    endS = std::max(endS, a.endS.value_or(a.startS));
    busyS += a.endS.value_or(a.startS) - a.startS;
    cpuS += a.cpuS.value_or(0.0);
    peakMemoryMiB = std::max(peakMemoryMiB, a.peakMemoryMiB.value_or(0.0));
    hosts.insert(a.host);
  }
  Json json() const {
    return {{"attempts", attempts},      {"resumed", resumed},
            {"without_end", withoutEnd}, {"wall_s", endS - startS},
            {"cpu_h", cpuS / 3600.0},    {"peak_memory_MiB", peakMemoryMiB}};
  }
};

struct Stage {
  std::string name;
  Use use;
  std::vector<Task> tasks;
  size_t done = 0;
  const Task* longest = nullptr;
  double longestS = 0.0;
};

void addAttempt(std::vector<Task>& tasks, const TaskAttempt& a) {
  if (tasks.empty() || tasks.back().name != a.task) tasks.push_back({a.task, a.startS, {}, {}, {}});
  Task& task = tasks.back();
  task.startS = std::min(task.startS, a.startS);
  if (a.endS) task.endS = std::max(*a.endS, task.endS.value_or(*a.endS));
  task.done |= a.done();
  task.exit = a.exit;
}

std::map<std::string, Stage> stagesOf(const RunRecords& run) {
  std::map<std::string, Stage> stages;
  for (const TaskAttempt& a : run.attempts) {
    Stage& stage = stages[a.stage];
    stage.name = a.stage;
    stage.use.add(a);
    addAttempt(stage.tasks, a);
  }
  for (auto& [name, stage] : stages) {
    for (const Task& task : stage.tasks) {
      stage.done += task.done;
      const double took = task.endS.value_or(task.startS) - task.startS;
      if (stage.longest != nullptr && took <= stage.longestS) continue;
      stage.longest = &task;
      stage.longestS = took;
    }
  }
  return stages;
}

Json criticalPath(const RunRecords& run, const std::map<std::string, Stage>& stages) {
  struct Best {
    double s = 0.0;
    const Stage *stage = nullptr, *before = nullptr;
  };
  std::map<std::string, Best> upTo;
  Best last;
  for (const std::string& name : stagesInOrder(run)) {
    Best best{0.0, &stages.at(name), nullptr};
    for (const std::string& before : run.after.at(name)) {
      const auto found = upTo.find(before);
      if (found == upTo.end() || (best.before != nullptr && found->second.s <= best.s)) continue;
      best.s = found->second.s;
      best.before = found->second.stage;
    }
    best.s += best.stage->longestS;
    upTo[name] = best;
    if (last.stage == nullptr || best.s > last.s) last = best;
  }
  Json chain = Json::array();
  for (const Stage* at = last.stage; at != nullptr; at = upTo[at->name].before)
    chain.push_back({{"stage", at->name}, {"task", at->longest->name}, {"wall_s", at->longestS}});
  std::reverse(chain.begin(), chain.end());
  return {{"wall_s", last.s}, {"tasks", chain}};
}

template <typename T>
Json orNull(const std::optional<T>& value) {
  return value ? Json(*value) : Json();
}

Json attemptJson(const TaskAttempt& a) {
  return {{"task", a.task},
          {"stage", a.stage},
          {"attempt", a.number},
          {"host", a.host},
          {"job", a.job},
          {"resumed", a.resumed},
          {"start_s", a.startS},
          {"end_s", orNull(a.endS)},
          {"cpu_s", orNull(a.cpuS)},
          {"peak_memory_MiB", orNull(a.peakMemoryMiB)},
          {"exit", orNull(a.exit)}};
}

Json unfinishedJson(const std::vector<std::string>& order,
                    const std::map<std::string, Stage>& stages) {
  Json list = Json::array();
  for (const std::string& name : order) {
    for (const Task& task : stages.at(name).tasks) {
      if (!task.done) list.push_back({{"task", task.name}, {"exit", orNull(task.exit)}});
    }
  }
  return list;
}

}  // namespace

std::vector<std::string> stagesInOrder(const RunRecords& run) {
  std::map<std::string, double> startS;
  for (const TaskAttempt& a : run.attempts) {
    const auto [found, fresh] = startS.try_emplace(a.stage, a.startS);
    if (!fresh) found->second = std::min(found->second, a.startS);
  }
  std::map<std::string, size_t> waitsFor;
  std::map<std::string, std::vector<std::string>> before;  // for each stage, those that wait for it
  std::set<std::pair<double, std::string>> ready;
  for (const auto& [stage, start] : startS) {
    for (const std::string& other : run.after.at(stage)) {
      if (!startS.contains(other)) continue;
      ++waitsFor[stage];
      before[other].push_back(stage);
    }
    if (waitsFor[stage] == 0) ready.insert({start, stage});
  }
  std::vector<std::string> order;
  while (!ready.empty()) {
    const std::string stage = ready.begin()->second;
    ready.erase(ready.begin());
    order.push_back(stage);
    for (const std::string& next : before[stage]) {
      if (--waitsFor[next] == 0) ready.insert({startS[next], next});
    }
  }
  if (order.size() < startS.size())
    throw InputError(
        "the records' stages come after each other in a circle; remove those of other runs");
  return order;
}

Json describeRun(const RunRecords& run) {
  const std::map<std::string, Stage> stages = stagesOf(run);
  const std::vector<std::string> order = stagesInOrder(run);
  Use all;
  std::map<std::string, Use> hosts;
  for (const TaskAttempt& a : run.attempts) {
    all.add(a);
    hosts[a.host].add(a);
  }
  Json json = all.json();
  json["start_s"] = all.startS;
  json["stages"] = Json::array();
  size_t tasks = 0;
  for (const std::string& name : order) {
    const Stage& stage = stages.at(name);
    tasks += stage.tasks.size();
    Json entry = stage.use.json();
    entry.update({{"stage", name},
                  {"tasks", stage.tasks.size()},
                  {"done", stage.done},
                  {"hosts", stage.use.hosts.size()},
                  {"longest_task", stage.longest->name},
                  {"longest_s", stage.longestS}});
    json["stages"].push_back(std::move(entry));
  }
  json["tasks"] = tasks;
  json["unfinished"] = unfinishedJson(order, stages);
  json["hosts"] = Json::array();
  for (const auto& [host, use] : hosts) {
    Json entry = use.json();
    entry.update({{"host", host}, {"busy_s", use.busyS}});
    json["hosts"].push_back(std::move(entry));
  }
  json["critical_path"] = criticalPath(run, stages);
  json["runs"] = Json::array();
  for (const TaskAttempt& a : run.attempts) json["runs"].push_back(attemptJson(a));
  return json;
}

}  // namespace bnvpl
