// --checkpoint: stages that are stopped and continued.
#include <chrono>

#include "formats/image/exr_io.h"
#include "formats/shard/checkpoint.h"
#include "tests/pipeline/tool_runner.h"
#include "tools/common/process/exit_codes.h"

namespace bnvpl {
namespace {

class ResumeRun : public PipelineTest {
 protected:
  // Runs the command to its end, with the output `whole`, and again with the output `pieces`: it is
  // stopped by SIGINT after ever longer parts of its time and restarted until it ends by itself.
  // Both outputs have the same bytes.
  void expectSameBytesInPieces(const std::string& name, const std::string& arguments,
                               const std::string& whole, const std::string& pieces) const {
    const auto begin = std::chrono::steady_clock::now();
    succeed(name, arguments + " -o " + path(whole));
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
    // The second run may be faster than the first one, beside other tests.
    int stopped = 0;
    for (double share = 0.4; stopped == 0 && share > 0.04; share *= 0.5)
      stopped = timesStopped(name, arguments + " -o " + path(pieces), share * taken.count());
    EXPECT_GE(stopped, 1) << name << " " << arguments;
    EXPECT_EQ(readAll(at(pieces)), readAll(at(whole))) << name << " " << arguments;
  }
  // How often the command was stopped after it had begun, so that it went on from its checkpoint.
  int timesStopped(const std::string& name, const std::string& arguments, double seconds) const {
    int stopped = 0;
    for (int run = 0; run < 30; ++run, seconds *= 1.3) {
      const Outcome r =
          shell("timeout --foreground -s INT " + std::to_string(seconds) + " '" BNVPL_BIN "/" +
                name + "' " + arguments + " --quiet --checkpoint " + path("work.checkpoint"));
      if (r.code == kExitOk) return stopped;
      EXPECT_EQ(r.code, 124) << r.err;  // exit code of `timeout` when it stopped the command
      if (!fs::exists(at("work.checkpoint"))) continue;
      EXPECT_TRUE(contains(r.err, "same command goes on from")) << r.err;
      ++stopped;
    }
    ADD_FAILURE() << name << " did not end";
    return 0;
  }
};

TEST_F(ResumeRun, StoppedAgainAndAgainGivesTheSameBytes) {
  makeStages(scene_);
  expectSameBytesInPieces("vpl-place", scene_ + " -n 200k", "placed.vpl", "placed-pieces.vpl");
  const std::string estimate = scene_ + " " + path("vpls.vpl") + " --irradiance-error 0";
  expectSameBytesInPieces("vpl-estimate", estimate + " --photons 1M", "whole.vpl", "pieces.vpl");
  const std::string render = scene_ + " " + path("lit.vpl") + " --size 64x48 --layers all",
                    photons = scene_ + " --integrator light --size 64x48";
  for (const std::string& work :
       {render + " --spp 48", render + " --passes 10", photons + " --spp 256"})
    expectSameBytesInPieces("vpl-render", work, "whole.exr", "pieces.exr");
  for (const auto& [name, work] : {std::pair{"vpl-estimate", estimate + " --photons 3M"},
                                   {"vpl-render", photons + " --spp 768"}})
    expectSameBytesInPieces(name, work + " --shard 2/3", name + std::string("-whole.shard"),
                            name + std::string("-pieces.shard"));
  EXPECT_FALSE(fs::exists(at("work.checkpoint")));  // done: nothing to continue
}

TEST_F(ResumeRun, LightGroupsOfGuidedPathsGiveTheSameBytes) {
  write("groups.toml", "[[mesh]]\nfile = " + scene_ +
                           "\n[[light]]\ntype = \"point\"\nposition = [0.1, 0.3, 0.1]\n"
                           "power = [1, 1, 1]\ngroup = \"fill\"\n");
  const std::string scene = path("groups.toml");
  makeStages(scene);
  const std::string render =
      scene + " " + path("lit.vpl") + " --integrator guided --size 64x48 --layers light_groups";
  for (const char* samples : {" --spp 32", " --passes 6"})
    expectSameBytesInPieces("vpl-render", render + samples, "whole.exr", "pieces.exr");
  EXPECT_NE(readExr(at("pieces.exr")).find("light_fill.R"), nullptr);
}

TEST_F(ResumeRun, SavingAllTheTimeGivesTheSameBytes) {
  makeStages(scene_);
  const std::string estimate = scene_ + " " + path("vpls.vpl") + " --photons 200k -o ";
  succeed("vpl-estimate", estimate + path("a.vpl"));
  succeed("vpl-estimate", estimate + path("b.vpl") + " --checkpoint-every 0 --checkpoint " +
                              path("work.checkpoint"));
  EXPECT_EQ(readAll(at("a.vpl")), readAll(at("b.vpl")));
}

TEST_F(ResumeRun, CheckpointsOfOtherRunsAndDamagedOnesAreRefused) {
  makeStages(scene_);
  const std::string estimate =
      scene_ + " " + path("vpls.vpl") + " -o " + path("x.vpl") + " --checkpoint " + path("c");
  interrupt("vpl-estimate", estimate + " --photons 1G --quiet", "c");
  const std::string bytes = readAll(at("c"));
  fail("vpl-estimate", estimate + " --photons 2G", kExitInput,
       {"/c:", "another run", "photons was 1000000000 and is now 2000000000"});
  fail("vpl-estimate", estimate + " --photons 1G --seed 3", kExitInput,
       {"seed was 1 and is now 3"});
  fail("vpl-render",
       scene_ + " " + path("lit.vpl") + " -o " + path("x.exr") + " --checkpoint " + path("c"),
       kExitInput, {"another run", "vpl-estimate"});
  succeed("vpl-eliminate", path("candidates.vpl") + " -o " + path("vpls.vpl") + " -n 61");
  fail("vpl-estimate", estimate + " --photons 1G", kExitInput, {"inputs vpls was"});
  for (const size_t length : {size_t{0}, size_t{30}, size_t{64}, bytes.size() - 1}) {
    write("c", bytes.substr(0, length));
    fail("vpl-estimate", estimate + " --photons 1G", kExitInput, {"/c:", "delete it"});
  }
  for (const size_t at : {size_t{0}, size_t{9}, size_t{70}, bytes.size() / 2}) {
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(damaged[at] ^ 4);
    write("c", damaged);
    fail("vpl-estimate", estimate + " --photons 1G", kExitInput, {"/c:", "delete it"});
  }
  EXPECT_FALSE(fs::exists(at("x.vpl")));
}

TEST_F(ResumeRun, UselessCheckpointsAreReplacedWhereThatIsAsked) {
  makeStages(scene_);
  const std::string estimate = scene_ + " " + path("vpls.vpl") + " --photons ",
                    replaced = " --checkpoint-replace --checkpoint " + path("c");
  succeed("vpl-estimate", estimate + "20k -o " + path("a.vpl"));
  interrupt("vpl-estimate",
            estimate + "1G -o " + path("b.vpl") + " --quiet --checkpoint " + path("c"), "c");
  const std::string bytes = readAll(at("c"));
  for (const std::string& useless : {bytes, bytes.substr(0, bytes.size() - 1)}) {
    write("c", useless);
    const Outcome r =
        tool("vpl-estimate", estimate + "20k --strict -o " + path("b.vpl") + replaced);
    EXPECT_EQ(r.code, kExitOk) << r.err;
    EXPECT_TRUE(contains(r.err, "/c:") && contains(r.err, "begins anew")) << r.err;
    EXPECT_FALSE(contains(r.err, "add --checkpoint-replace")) << r.err;
    EXPECT_EQ(readAll(at("a.vpl")), readAll(at("b.vpl")));
    EXPECT_FALSE(fs::exists(at("c")));
  }
  write("c", "mine");
  fail("vpl-estimate", estimate + "20k -o " + path("b.vpl") + replaced, kExitInput, {"/c:"});
  EXPECT_EQ(readAll(at("c")), "mine");
}

TEST_F(ResumeRun, AnotherProcessorIsAnotherRun) {
  makeStages(scene_);
  const std::string estimate = scene_ + " " + path("vpls.vpl") + " -o " + path("x.vpl") +
                               " --photons 1G --checkpoint " + path("c");
  interrupt("vpl-estimate", estimate + " --quiet", "c");
  if (HasFatalFailure()) return;
  CheckpointFile saved = *findCheckpoint(at("c"));
  const std::string key = "\"processor_id\":\"";
  const size_t id = saved.run.find(key);
  ASSERT_NE(id, std::string::npos) << saved.run;
  saved.run.insert(id + key.size(), "0");
  writeCheckpoint(at("c"), saved);
  fail("vpl-estimate", estimate, kExitInput, {"another run", "processor_id was \"0"});
}

TEST_F(ResumeRun, AnotherViewIsAnotherRun) {
  const std::string scene = copyVeachDoor();
  const std::string render =
      scene + " --integrator path --spp 1M -o " + path("x.exr") + " --checkpoint " + path("c");
  interrupt("vpl-render", render + " --quiet", "c");
  std::string toml = readAll(at("veach-door/scene.toml"));
  toml.replace(toml.find("width = 48"), 10, "width = 32");
  write("veach-door/scene.toml", toml);
  fail("vpl-render", render, kExitInput, {"another run", "view size was \"48x27\""});
}

}  // namespace
}  // namespace bnvpl
