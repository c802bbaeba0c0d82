// vpl-render with --time, --target-error and --passes.
#include <nlohmann/json.hpp>

#include "tests/pipeline/tool_runner.h"
#include "tests/support/sanitizers.h"
#include "tools/common/process/exit_codes.h"

namespace bnvpl {
namespace {

class BudgetRun : public PipelineTest {
 protected:
  std::string paths(const std::string& more) const {
    return scene_ + " --integrator path --size 32x24 " + more;
  }
  nlohmann::json stats() const { return nlohmann::json::parse(readAll(at("s.json"))); }
  // Interrupts a run by `budget`, which does not end by itself, so that the checkpoint c remains.
  void stop(const std::string& budget, double seconds = 0.5) const {
    interrupt("vpl-render", paths(budget), "c", seconds);
  }
  std::string passesDone() const { return std::to_string(stats()["passes"].get<uint64_t>()); }
};

TEST_F(BudgetRun, NonsenseIsRefusedOnOneLine) {
  const std::string o = " -o " + path("x.exr");
  for (const char* bad : {"0s", "-5s", "1e300h", "nans", "0.0001s"}) {
    fail("vpl-render", paths(std::string("--time ") + bad + o), kExitUsage, {"--time: '", "2m"});
  }
  for (const char* bad : {"60", "s", "1d", "1m30", "two", "60 s"}) {
    fail("vpl-render", paths(std::string("--time '") + bad + "'" + o), kExitUsage,
         {"is not a duration; write one such as 90s, 2m or 1.5h"});
  }
  for (const char* bad : {"0", "-1", "nan", "1%"}) {
    fail("vpl-render", paths(std::string("--target-error ") + bad + o), kExitUsage,
         {"--target-error: '"});
  }
  fail("vpl-render", paths("--passes 1" + o), kExitUsage, {"--passes: '1' is out of range"});
  fail("vpl-render", paths("--time 1s --spp 7" + o), kExitUsage,
       {"--spp: with --time", "at least 8"});
  fail("vpl-render", paths("--adaptive off" + o), kExitUsage,
       {"--adaptive has no effect; it needs --time or --target-error or --passes"});
  fail("vpl-render", paths("--layers error" + o), kExitUsage, {"--layers: 'error'", "--passes"});
  EXPECT_FALSE(fs::exists(at("x.exr")));
}

// --passes with the number of passes of a run by --time repeats its image.
TEST_F(BudgetRun, ATimeIsKeptAndItsImageRepeated) {
  const std::string more = "--layers all --stats " + path("s.json");
  const Outcome r = tool("vpl-render", paths("--time 2s " + more + " -o " + path("a.exr")));
  ASSERT_EQ(r.code, kExitOk) << r.err;
  const nlohmann::json done = stats();
  EXPECT_EQ(done["ended_by"], "time");
  EXPECT_LE(done["passes_time_s"].get<double>(), 4.0);
  EXPECT_GT(done["passes_time_s"].get<double>(), 0.5);
  EXPECT_TRUE(contains(r.out, "--passes " + passesDone() + " repeats this image")) << r.out;
  succeed("vpl-render",
          paths("--passes " + passesDone() + " --threads 3 " + more + " -o " + path("b.exr")));
  EXPECT_EQ(stats()["relative_error"], done["relative_error"]);
  EXPECT_EQ(stats()["ended_by"], "passes");
  EXPECT_TRUE(readAll(at("a.exr")) == readAll(at("b.exr")));
  const Outcome info = tool("vpl-inspect", "info " + path("a.exr"));
  for (const std::string& part : {"bnvpl.passes = " + passesDone(), std::string("error.G"),
                                  std::string("samples"), "passes " + passesDone()}) {
    EXPECT_TRUE(contains(info.out, part)) << part << info.out;
  }
}

// Ten passes of four samples a pixel would take several times as long, so that passes have fewer.
TEST_F(BudgetRun, ALargeFilmHasPassesThatFitIntoTheTime) {
  if (kSanitized) GTEST_SKIP() << "sanitizers take several times as long";
  const std::string film =
      scene_ + " --integrator path --threads 2 --size 1024x768 --stats " + path("s.json") + " -o ";
  succeed("vpl-render", film + path("a.exr") + " --time 3s");
  EXPECT_LT(stats()["time_s"].get<double>(), 6.0);
  EXPECT_GE(stats()["passes"].get<int>(), 2);
  const uint64_t spp = stats()["pass_spp"];  // adaptive passes have this many on average
  EXPECT_LE(spp, 2u);
  succeed("vpl-render", film + path("b.exr") + " --passes " + passesDone() + " --pass-spp " +
                            std::to_string(spp));
  EXPECT_TRUE(readAll(at("a.exr")) == readAll(at("b.exr")));
}

TEST_F(BudgetRun, AnErrorIsReached) {
  succeed("vpl-render",
          paths("--target-error 0.1 -o " + path("a.exr") + " --stats " + path("s.json")));
  EXPECT_EQ(stats()["ended_by"], "error");
  EXPECT_LE(stats()["relative_error"].get<double>(), 0.1);
  const std::string reached = passesDone();
  const Outcome r = tool("vpl-render", paths("--target-error 0.1 --spp 16 -o " + path("b.exr") +
                                             " --stats " + path("s.json")));
  EXPECT_EQ(r.code, kExitOk);
  EXPECT_EQ(stats()["ended_by"], "passes");
  EXPECT_LT(std::stoul(passesDone()), std::stoul(reached));
}

// Waits for the preview of a background run, then stops the run.
TEST_F(BudgetRun, ThePreviewIsThereBeforeTheImage) {
  const Outcome r =
      shell("'" BNVPL_BIN "/vpl-render' " +
            paths("--time 1h --quiet -o " + path("x.exr") + " --png " + path("x.png")) +
            " & for i in $(seq 200); do [ -e " + path("x.png") +
            " ] && break; sleep 0.2; done; kill -TERM $!; wait $!");
  EXPECT_EQ(r.code, 143) << r.err;
  ASSERT_TRUE(fs::exists(at("x.png"))) << r.err;
  EXPECT_EQ(readAll(at("x.png")).substr(1, 3), "PNG");
  EXPECT_FALSE(fs::exists(at("x.exr")));
}

TEST_F(BudgetRun, ACheckpointKeepsTheTimeSpentAndMayGetAnother) {
  const std::string work =
      " --quiet --checkpoint " + path("c") + " -o " + path("a.exr") + " --stats " + path("s.json");
  stop("--time 1h" + work, 3);
  fail("vpl-render", paths("--time 1h --seed 2" + work), kExitInput, {"seed was 1 and is now 2"});
  succeed("vpl-render", paths("--time 1s" + work));  // already spent: the current pass ends
  EXPECT_GT(stats()["passes_time_s"].get<double>(), 1.0);
  EXPECT_LT(stats()["time_s"].get<double>(), stats()["passes_time_s"].get<double>());
  succeed("vpl-render", paths("--passes " + passesDone() + " --quiet -o " + path("b.exr")));
  EXPECT_TRUE(readAll(at("a.exr")) == readAll(at("b.exr")));
  EXPECT_FALSE(fs::exists(at("c")));
}

TEST_F(BudgetRun, ACheckpointContinuesWithAnyBudget) {
  const std::string work =
      " --quiet --checkpoint " + path("c") + " -o " + path("a.exr") + " --stats " + path("s.json");
  stop("--time 1h" + work);
  const fs::path kept = at("kept");
  fs::copy_file(at("c"), kept);
  for (const std::string& budget : {std::string("--passes 2"), std::string("--target-error 10"),
                                    std::string("--passes 2 --time 1h")}) {
    fs::copy_file(kept, at("c"), fs::copy_options::overwrite_existing);
    succeed("vpl-render", paths(budget + work));
    EXPECT_FALSE(fs::exists(at("c"))) << budget;
  }
  stop("--passes 100000000" + work);
  succeed("vpl-render", paths("--time 1s" + work));
}

}  // namespace
}  // namespace bnvpl
