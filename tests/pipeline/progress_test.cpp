// What a tool says of its progress.
#include "tests/pipeline/tool_runner.h"
#include "tools/common/progress_meter.h"

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
  EXPECT_EQ(progressText("samples", 12000000, 40000000, 53.6),
            "samples 12M of 40M (30 %), 2 min 05 s left");
  EXPECT_EQ(progressText("samples", 12000000, 0, 34), "samples 12M in 34 s");
  EXPECT_EQ(progressText("photons", 1, 4, 2000), "photons 1 of 4 (25 %), 1 h 40 min left");
  EXPECT_EQ(progressText("photons", 0, 4, 10), "photons 0 of 4 (0 %)");
  EXPECT_EQ(progressText("photons", 4, 4, 10), "photons 4 of 4 (100 %), 0 s left");
}

// The first per mille may take most of the time.
TEST(Progress, TheTimeLeftWaitsForEnoughToTellIt) {
  EXPECT_EQ(progressText("candidates", 19, 1000, 9.9), "candidates 19 of 1k (2 %)");
  EXPECT_EQ(progressText("candidates", 20, 1000, 9.9),
            "candidates 20 of 1k (2 %), 8 min 05 s left");
  EXPECT_EQ(progressText("candidates", 1, 1000, 12), "candidates 1 of 1k (0 %), 3 h 20 min left");
}

using ProgressOfTools = PipelineTest;

// The first line comes after ten seconds.
TEST_F(ProgressOfTools, BeginsWithTheToolsNameOffATerminal) {
  const Outcome r = shell("timeout -s INT 15 '" BNVPL_BIN "/vpl-render' " + scene_ +
                          " --integrator path --spp 4M -o " + path("x.exr"));
  EXPECT_EQ(r.code, 124) << r.err;
  EXPECT_TRUE(contains("\n" + r.err, "\nvpl-render: samples ")) << r.err;
  EXPECT_TRUE(contains(r.err, " left\n")) << r.err;
}

}  // namespace
}  // namespace bnvpl
