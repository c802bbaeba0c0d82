// What a tool prints about its progress.
#include <algorithm>
#include <cmath>

#include "tests/pipeline/tool_runner.h"
#include "tools/common/process/exit_codes.h"
#include "tools/common/run/progress_meter.h"

namespace bnvpl {
namespace {

TEST(Durations, SecondsMinutesAndHours) {
  const std::pair<double, const char*> durations[] = {{-1, "0 s"},
                                                      {0, "0 s"},
                                                      {0.4, "0 s"},
                                                      {47.3, "47 s"},
                                                      {59.4, "59 s"},
                                                      {59.6, "1 min 00 s"},
                                                      {125, "2 min 05 s"},
                                                      {3599.4, "59 min 59 s"},
                                                      {3599.6, "1 h 00 min"},
                                                      {6367, "1 h 46 min"},
                                                      {7199, "2 h 00 min"},
                                                      {90000, "25 h 00 min"},
                                                      {1e300, "1000000 h 00 min"}};
  for (const auto& [seconds, text] : durations) EXPECT_EQ(durationText(seconds), text) << seconds;
}

TEST(Progress, Line) {
  EXPECT_EQ(progressText("samples", 12000000, 40000000, 53.6, {.leftS = 125}),
            "samples 12M of 40M (30 %), 2 min 05 s left");
  EXPECT_EQ(progressText("samples", 12000000, 0, 34, {}), "samples 12M in 34 s");
  EXPECT_EQ(progressText("samples", 12000000, 0, 34, {.leftS = 26, .error = 0.0314}),
            "samples 12M in 34 s, 26 s left, error 0.031");
  EXPECT_EQ(progressText("photons", 1, 4, 2000, {}), "photons 1 of 4 (25 %)");
  EXPECT_EQ(progressText("photons", 999, 1000, 10, {.leftS = 0.2}),
            "photons 999 of 1k (99 %), 0 s left");
}

TEST(TimeLeft, OfASteadyWorkIsExact) {
  TimeLeft left;
  for (int s = 0; s <= 30; ++s) left.report(100.0 + s, uint64_t(10 * s));
  EXPECT_NEAR(left.seconds(1000).value(), 70.0, 1e-9);
  left.skip(500.0);  // another task
  left.report(631.0, 310);
  EXPECT_NEAR(left.seconds(1000).value(), 69.0, 1e-9);
}

// A minute of loading precedes the first unit, and the units of a checkpoint arrive at once.
TEST(TimeLeft, CountsOnlyTheWorkItself) {
  TimeLeft left;
  left.report(60.0, 0);
  left.report(60.001, 5000);
  for (int s = 1; s <= 20; ++s) left.report(60.0 + s, 5000 + 10 * uint64_t(s));
  EXPECT_NEAR(left.seconds(6000).value(), 80.0, 1.0);
}

// The first units may take far longer than the others.
TEST(TimeLeft, FollowsAWorkThatBecomesFasterAndDoesNotJump) {
  TimeLeft left;
  uint64_t done = 0;
  double before = 0.0, told = 0.0;
  for (int tick = 0; done < 10000; ++tick) {
    const double s = 0.2 * tick;
    left.report(s, done += s < 20.0 ? 5 : 50);
    const auto now = left.seconds(10000);
    if (!now) continue;
    if (before > 0.0) {
      EXPECT_LT(std::fabs(*now - before), 0.35 * before + 1.0) << "at " << s;
    }
    before = *now;
    if (done > 5000 && told == 0.0) told = *now;
  }
  EXPECT_LT(told, 2.0 * 20.0);  // it takes 20 s
}

TEST(TimeLeft, WaitsForEnoughToTellIt) {
  TimeLeft left;
  EXPECT_FALSE(left.seconds(1000).has_value());
  left.report(0.0, 0);
  left.report(1.9, 500);
  EXPECT_FALSE(left.seconds(1000).has_value()) << "under two seconds";
  left = {};
  left.report(0.0, 0);
  left.report(9.9, 19);
  EXPECT_FALSE(left.seconds(1000).has_value()) << "under 2 % in under ten seconds";
  left.report(10.1, 20);
  EXPECT_TRUE(left.seconds(1000).has_value());
  left.report(11.0, 1000);
  EXPECT_FALSE(left.seconds(1000).has_value()) << "nothing is left";
}

using ProgressOfTools = PipelineTest;

// The first line comes after ten seconds, nearly all of which the tool spends stopped.
TEST_F(ProgressOfTools, BeginsWithTheToolsNameOffATerminal) {
  write("run.sh", "'" BNVPL_BIN "/vpl-render' " + scene_ +
                      " --integrator path --spp 4M --threads 1 -o " + path("x.exr") +
                      " & sleep 1; kill -STOP $!; sleep 10; kill -CONT $!; sleep 4; kill $!; "
                      "wait $!\n");
  const Outcome r = shell("sh " + path("run.sh"));
  EXPECT_EQ(r.code, 128 + 15) << r.err;
  EXPECT_TRUE(contains("\n" + r.err, "\nvpl-render: samples ")) << r.err;
  EXPECT_TRUE(contains(r.err, " left\n")) << r.err;
}

// The final content of a terminal: \\r returns to the start of the line, and ESC [ K erases the
// rest of the line.
std::vector<std::string> screenOf(const std::string& typed) {
  std::vector<std::string> lines{""};
  size_t column = 0;
  for (size_t i = 0; i < typed.size(); ++i) {
    std::string& line = lines.back();
    if (typed[i] == '\n') {
      lines.emplace_back();
      column = 0;
    } else if (typed[i] == '\r') {
      column = 0;
    } else if (typed.compare(i, 3, "\x1b[K") == 0) {
      line.resize(column);
      i += 2;
    } else {
      line.resize(std::max(line.size(), column + 1), ' ');
      line[column++] = typed[i];
    }
  }
  return lines;
}

// In a terminal every stage erases its progress line before it prints the summary.
TEST_F(ProgressOfTools, IsErasedFromATerminalBeforeAnythingElseIsPrinted) {
  makeStages(scene_);
  const std::pair<std::string, std::string> lines[] = {
      {"vpl-place", scene_ + " -n 400k -o " + path("big.vpl")},
      {"vpl-eliminate", path("big.vpl") + " -n 40k -o " + path("kept.vpl")},
      {"vpl-estimate",
       scene_ + " " + path("vpls.vpl") + " --photons 1M --irradiance-error 0 -o " + path("l.vpl")},
      {"vpl-render", scene_ + " " + path("lit.vpl") + " --spp 64 -o " + path("i.exr")}};
  for (const auto& [name, arguments] : lines) {
    write("run.sh", "stty cols 60; '" BNVPL_BIN "/" + name + "' --threads 2 " + arguments + "\n");
    const Outcome r = shell("script -qec 'sh " + at("run.sh").string() + "' /dev/null");
    EXPECT_EQ(r.code, kExitOk) << r.out;
    EXPECT_TRUE(contains(r.out, " of ")) << name << " was too fast to show progress: " << r.out;
    EXPECT_FALSE(contains(r.out, "balance")) << r.out;
    for (const std::string& line : screenOf(r.out)) {
      EXPECT_TRUE(line.empty() || line.starts_with(name + ": ")) << line;
      EXPECT_FALSE(contains(line, " left")) << line;
    }
  }
}

}  // namespace
}  // namespace bnvpl
