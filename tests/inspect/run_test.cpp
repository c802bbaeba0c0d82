// vpl-inspect run: task records, the report over them, the timeline, and malformed records.
#include <sys/stat.h>

#include "tests/inspect/run_inspect.h"
#include "tools/common/process/exit_codes.h"
#include "tools/inspect/run/run_report.h"
#include "tools/inspect/run/run_timeline.h"

namespace bnvpl {
namespace {

class Run : public InspectTest {
 protected:
  // Adds a record of one attempt at a task of a stage; `more` adds or replaces fields.
  void record(const std::string& task, const std::string& stage, unsigned number, double startS,
              double endS, int exit, const Json& more = Json::object()) const {
    Json json{{"task", task},
              {"stage", stage},
              {"attempt", number},
              {"host", "n1"},
              {"job", "7"},
              {"start_s", startS},
              {"end_s", endS},
              {"exit", exit},
              {"cpu_s", endS - startS},
              {"resumed", number > 1},
              {"peak_memory_MiB", 10.0 * number}};
    json.update(more);
    for (const char* key : {"end_s", "exit", "cpu_s"}) {
      if (json[key].is_null()) json.erase(key);
    }
    write(task + "." + std::to_string(number), json.dump());
  }
  void write(const std::string& name, const std::string& text) const {
    writeAll(at(name + ".task.json"), text);
  }
  // Two shards, the second of which lost its machine once, and their merge.
  void recordPlace() const {
    record("place-1-of-2", "place", 1, 1000, 1010, 0);
    record("place-2-of-2", "place", 1, 1000, 0, 0,
           {{"end_s", nullptr}, {"exit", nullptr}, {"cpu_s", nullptr}, {"host", "n2"}});
    record("place-2-of-2", "place", 2, 1012, 1018, 0);
    record("merge-place", "merge-place", 1, 1020, 1024, 0, {{"after", {"place"}}});
  }
  std::string problemOf(const std::string& text) const {
    write("bad.1", text);
    const Outcome result = runInspect("run '" + at("").string() + "'");
    EXPECT_EQ(result.code, kExitInput) << result.output;
    EXPECT_EQ(std::count(result.output.begin(), result.output.end(), '\n'), 1) << result.output;
    EXPECT_TRUE(contains(result.output, "bad.1.task.json: ")) << result.output;
    return result.output;
  }
};

TEST_F(Run, SumsUpStagesHostsAndTheCriticalPath) {
  recordPlace();
  const Json d = describeRun(readRunRecords(at("")));
  EXPECT_EQ(d["tasks"], 3);
  EXPECT_EQ(d["attempts"], 4);
  EXPECT_EQ(d["resumed"], 1);
  EXPECT_EQ(d["without_end"], 1);
  EXPECT_EQ(d["wall_s"], 24);
  EXPECT_DOUBLE_EQ(d["cpu_h"].get<double>(), 20.0 / 3600.0);
  EXPECT_TRUE(d["unfinished"].empty());
  ASSERT_EQ(d["stages"].size(), 2u);
  const Json& place = d["stages"][0];
  EXPECT_EQ(place["stage"], "place");
  EXPECT_EQ(place["tasks"], 2);
  EXPECT_EQ(place["done"], 2);
  EXPECT_EQ(place["attempts"], 3);
  EXPECT_EQ(place["hosts"], 2);
  EXPECT_EQ(place["wall_s"], 18);
  EXPECT_EQ(place["peak_memory_MiB"], 20);
  EXPECT_EQ(place["longest_task"], "place-2-of-2");  // includes the wait between its attempts
  EXPECT_EQ(place["longest_s"], 18);
  ASSERT_EQ(d["hosts"].size(), 2u);
  EXPECT_EQ(d["hosts"][0]["host"], "n1");
  EXPECT_EQ(d["hosts"][0]["busy_s"], 20);
  EXPECT_EQ(d["hosts"][1]["without_end"], 1);
  EXPECT_EQ(d["critical_path"]["wall_s"], 22);
  ASSERT_EQ(d["critical_path"]["tasks"].size(), 2u);
  EXPECT_EQ(d["critical_path"]["tasks"][1]["task"], "merge-place");
  EXPECT_EQ(d["runs"].size(), 4u);
}

TEST_F(Run, TheCriticalPathTakesTheLongerBranch) {
  record("a", "a", 1, 0, 5, 0);
  record("b", "b", 1, 0, 9, 0);
  record("c", "c", 1, 10, 11, 0, {{"after", {"a", "b", "never-ran"}}});
  record("d", "d", 1, 0, 3, 0);
  const Json path = describeRun(readRunRecords(at("")))["critical_path"];
  EXPECT_EQ(path["wall_s"], 10);
  EXPECT_EQ(path["tasks"][0]["task"], "b");
  EXPECT_EQ(path["tasks"][1]["task"], "c");
}

TEST_F(Run, CountsTheLatestRunOfATask) {
  record("place", "place", 1, 100, 200, 0);
  record("place", "place", 2, 900, 910, 137);
  record("place", "place", 10, 920, 930, 0);  // sorts after 2
  const RunRecords run = readRunRecords(at(""));
  ASSERT_EQ(run.attempts.size(), 2u);
  EXPECT_EQ(run.attempts[0].number, 2u);
  EXPECT_EQ(run.attempts[1].number, 10u);
}

TEST_F(Run, NamesWhatIsNotDone) {
  recordPlace();
  record("eliminate", "eliminate", 1, 1030, 1031, 137, {{"after", {"merge-place"}}});
  record("estimate-1-of-1", "estimate", 1, 1040, 0, 0,
         {{"end_s", nullptr}, {"exit", nullptr}, {"cpu_s", nullptr}});
  const Outcome result = runInspect("run '" + at("").string() + "'");
  EXPECT_EQ(result.code, kExitOk);
  EXPECT_TRUE(contains(result.output, "not done: eliminate, exit code 137")) << result.output;
  EXPECT_TRUE(contains(result.output, "not done: estimate-1-of-1, which runs")) << result.output;
}

TEST_F(Run, DrawsABarForEachAttempt) {
  recordPlace();
  record("render", "<render> & \"co\"", 1, 1030, 1031, 1, {{"host", "<n3>"}});
  const std::string svg = timelineSvg(readRunRecords(at("")));
  const auto countOf = [&](const std::string& part) {
    size_t n = 0;
    for (size_t i = svg.find(part); i != std::string::npos; i = svg.find(part, i + 1)) ++n;
    return n;
  };
  EXPECT_EQ(countOf("<title>"), 5u);
  EXPECT_EQ(countOf("class=\"done\""), 3u);
  EXPECT_EQ(countOf("class=\"failed\""), 2u);
  EXPECT_EQ(countOf("url(#lost)"), 1u);
  EXPECT_EQ(countOf("class=\"host\""), 3u);
  EXPECT_TRUE(contains(svg, "&lt;render&gt; &amp; &quot;co&quot;"));
  EXPECT_FALSE(contains(svg, "<n3>"));
  EXPECT_FALSE(contains(svg, "nan"));
}

TEST_F(Run, TasksThatRunTogetherHaveLanesOfTheirOwn) {
  for (int i = 1; i <= 3; ++i) record("t" + std::to_string(i), "s", 1, 0, 10, 0);
  record("t4", "s", 1, 10, 20, 0);
  const std::string svg = timelineSvg(readRunRecords(at("")));
  EXPECT_TRUE(contains(svg, "height=\"48.00\"")) << svg;  // three lanes of 16
}

TEST_F(Run, PrintsAndWritesFiles) {
  recordPlace();
  const std::string folder = "run '" + at("").string() + "' ", svg = at("t.svg").string();
  const Outcome text = runInspect(folder + "--svg '" + svg + "'");
  EXPECT_EQ(text.code, kExitOk) << text.output;
  EXPECT_TRUE(
      contains(text.output, "critical path: 22.0 s: place-2-of-2 18.0 s, merge-place 4.0 s"))
      << text.output;
  EXPECT_TRUE(contains(text.output, "1970-01-01 00:16:40 UTC")) << text.output;
  EXPECT_EQ(readAll(svg), timelineSvg(readRunRecords(at(""))));
  const Outcome json = runInspect(folder + "--json");
  EXPECT_EQ(Json::parse(json.output)["tasks"], 3);
  EXPECT_EQ(runInspect(folder + "--svg '" + at("t.png").string() + "'").code, kExitUsage);
  EXPECT_EQ(runInspect("run").code, kExitUsage);
}

TEST_F(Run, RefusesFoldersWithoutRecords) {
  EXPECT_EQ(runInspect("run '" + at("absent").string() + "'").code, kExitInput);
  const Outcome empty = runInspect("run '" + at("").string() + "'");
  EXPECT_EQ(empty.code, kExitInput);
  EXPECT_TRUE(contains(empty.output, "holds no *.task.json")) << empty.output;
}

TEST_F(Run, RefusesDamagedRecordsByName) {
  const std::string good = R"("task":"a","stage":"s","host":"h","attempt":1)";
  EXPECT_TRUE(contains(problemOf(""), "no record"));
  EXPECT_TRUE(contains(problemOf("[1]"), "no record"));
  EXPECT_TRUE(contains(problemOf("{\"task\": \"\xff\"}"), "no record"));
  EXPECT_TRUE(contains(problemOf(std::string(100000, '[')), "no record"));
  EXPECT_TRUE(contains(problemOf("{}"), "'task' is missing"));
  EXPECT_TRUE(contains(problemOf(R"({"task": 3})"), "'task' is no text"));
  EXPECT_TRUE(contains(problemOf(R"({"task": "\u001b[2J"})"), "printable"));
  EXPECT_TRUE(contains(problemOf("{\"task\": \"" + std::string(300, 'x') + "\"}"), "printable"));
  EXPECT_TRUE(contains(problemOf("{" + good + "}"), "'start_s' is missing"));
  for (const char* time : {"-1", "1e300", "1e999", "null", "\"5\"", "true"}) {
    const std::string text = "{" + good + ",\"start_s\":" + time + "}";
    const std::string problem = problemOf(text);
    EXPECT_TRUE(contains(problem, "start_s") || contains(problem, "no record")) << problem;
  }
  EXPECT_TRUE(
      contains(problemOf("{" + good + R"(,"start_s":5,"end_s":4,"exit":0})"), "ends before"));
  EXPECT_TRUE(contains(problemOf("{" + good + R"(,"start_s":5,"end_s":6})"), "without the other"));
  EXPECT_TRUE(contains(problemOf("{" + good + R"(,"start_s":5,"exit":256})"), "'exit'"));
  EXPECT_TRUE(contains(problemOf("{" + good + R"(,"start_s":5,"after":"s"})"), "'after'"));
  EXPECT_TRUE(contains(problemOf("{" + good + R"(,"start_s":5,"after":[1]})"), "'after'"));
  fs::remove(at("bad.1.task.json"));
  ASSERT_EQ(::mkfifo(at("bad.1.task.json").c_str(), 0600), 0);
  const Outcome pipe = runInspect("run '" + at("").string() + "'");
  EXPECT_EQ(pipe.code, kExitInput);
  EXPECT_TRUE(contains(pipe.output, "not a regular file")) << pipe.output;
}

TEST_F(Run, RefusesStagesInACircle) {
  record("a", "a", 1, 0, 5, 0, {{"after", {"b"}}});
  record("b", "b", 1, 0, 5, 0, {{"after", {"a"}}});
  const Outcome result = runInspect("run '" + at("").string() + "'");
  EXPECT_EQ(result.code, kExitInput);
  EXPECT_TRUE(contains(result.output, "circle")) << result.output;
}

}  // namespace
}  // namespace bnvpl
