// --processor any gives the same bytes on all processors; tests/bytes/processors.py emulates some.
#include "tests/pipeline/tool_runner.h"
#include "tools/common/process/exit_codes.h"

namespace bnvpl {
namespace {

using ProcessorRun = PipelineTest;
const std::string kAny = " --quiet --processor any";

TEST_F(ProcessorRun, ShardsForAnyMergeToTheBytesOfOneRun) {
  makeStages(scene_);
  for (const auto& [name, arguments, whole] :
       {std::tuple{"vpl-place", scene_ + " -n 2k", "placed.vpl"},
        std::tuple{"vpl-estimate", scene_ + " " + path("vpls.vpl") + " --photons 20k", "whole.vpl"},
        std::tuple{"vpl-render", scene_ + " " + path("lit.vpl") + " --spp 1", "whole.exr"}}) {
    const auto shard = [&, tool = name](const std::string& part) {
      return tool + ("-" + part) + ".shard";
    };
    for (const char* part : {"1", "2"}) {
      succeed(name, arguments + kAny + " --shard " + part + "/2 -o " + path(shard(part)));
    }
    succeed(name, arguments + kAny + " -o " + path(whole));
    const std::string merged = std::string("merged-") + whole;
    succeed("vpl-merge", path(shard("1")) + " " + path(shard("2")) + " --quiet -o " + path(merged));
    EXPECT_EQ(readAll(at(merged)), readAll(at(whole))) << name;
    const Outcome info = tool("vpl-inspect", "info " + path(whole));
    EXPECT_TRUE(contains(info.out, "; for any processor")) << info.out << info.err;
    EXPECT_TRUE(contains(readAll(at(shard("1"))), " --processor any")) << "the command of others";
  }
}

// Such shards differ in bits from those of one run.
TEST_F(ProcessorRun, ShardsForAnyAndForThisAreNotMixed) {
  const std::string place = scene_ + " -n 2k --quiet --shard ";
  succeed("vpl-place", place + "1/2 -o " + path("this.shard"));
  succeed("vpl-place", place + "2/2 --processor any -o " + path("any.shard"));
  const std::string output = " -o " + path("x.vpl");
  fail("vpl-merge", path("this.shard") + " " + path("any.shard") + output, kExitInput,
       {"any.shard: is of another run than", "this.shard",
        "processor was absent and is now \"any\""});
  fail("vpl-merge", path("any.shard") + " " + path("this.shard") + output, kExitInput,
       {"this.shard: is of another run than", "any.shard",
        "processor was \"any\" and is now absent"});
}

TEST_F(ProcessorRun, AnyIsAnotherRunForACheckpoint) {
  makeStages(scene_);
  const std::string estimate = scene_ + " " + path("vpls.vpl") + " -o " + path("x.vpl") +
                               " --quiet --photons 1G --checkpoint " + path("c");
  interrupt("vpl-estimate", estimate, "c");
  fail("vpl-estimate", estimate + kAny.substr(8), kExitInput, {"another run", "is now \"any\""});
}

// The tool restarts itself with the missing settings in GLIBC_TUNABLES. A shard holds the processor
// id, and so the digits of every function.
TEST_F(ProcessorRun, TunablesOfTheUserStay) {
  const std::string place =
      "'" BNVPL_BIN "/vpl-place' " + scene_ + " -n 1k --shard 1/1" + kAny + " -o ";
  const auto placed = [&](const std::string& tunables, const std::string& file) {
    const Outcome r = shell(place + path(file), "export GLIBC_TUNABLES=" + tunables + ";");
    EXPECT_EQ(r.code, 0) << r.err;
    return readAll(at(file));
  };
  const std::string plain = placed("", "a.shard");
  for (const char* tunables :
       {"glibc.cpu.hwcaps=-FMA,-FMA4", "glibc.cpu.hwcaps=-AVX2", "glibc.malloc.arena_max=1",
        "glibc.cpu.hwcaps=-AVX2,-FMA:glibc.malloc.arena_max=1"}) {
    EXPECT_EQ(placed(tunables, "b.shard"), plain) << tunables;
  }
}

// The restarted tool keeps its process and name, and ends as usual, on signals and on errors.
TEST_F(ProcessorRun, TheToolThatIsStartedAnewIsTheSame) {
  fail("vpl-place", scene_ + " -n 1k --processor 486 -o " + path("x.vpl"), kExitUsage,
       {"--processor", "this", "any"});
  fail("vpl-place", path("none.toml") + kAny + " -n 1k -o " + path("x.vpl"), kExitInput,
       {"none.toml"});
  const Outcome r = shell("sh -c \"'" BNVPL_BIN "/vpl-render' " + scene_ +
                          " --integrator path --spp 100k" + kAny + " -o " + path("x.exr") +
                          " & sleep 1; cat /proc/\\$!/comm; kill -TERM \\$!; wait \\$!\"");
  EXPECT_TRUE(contains(r.out, "vpl-render")) << r.out << r.err;
  EXPECT_TRUE(contains(r.err, "interrupted (SIGTERM)")) << r.err;
  EXPECT_EQ(r.code, 128 + 15) << r.err;
}

TEST_F(ProcessorRun, PipelinesHandItToAllStages) {
  const std::string make = "make -n -f pipelines/Makefile SHARDS=2 OUT=" + path("m") +
                           " BIN=" BNVPL_BIN_FROM_SOURCE " PROCESSOR=any";
  const Outcome r = shell(make);
  for (const char* stage : {"vpl-place ", "vpl-eliminate ", "vpl-estimate ", "vpl-render "}) {
    const size_t at = r.out.find(stage);
    ASSERT_NE(at, std::string::npos) << r.out << r.err;
    EXPECT_TRUE(contains(r.out.substr(at, r.out.find('\n', at) - at), " --processor any")) << r.out;
  }
  const Outcome g = shell(
      "pipelines/generate_ninja.py scenes/test/one-bounce.toml --shards 2 --processor any "
      "--bin " BNVPL_BIN_FROM_SOURCE " --out " +
      path("n"));
  ASSERT_EQ(g.code, 0) << g.err;
  const std::string graph = readAll(at("n/build.ninja"));
  size_t count = 0;
  for (size_t at = 0; (at = graph.find("--processor any", at)) != std::string::npos; ++at) ++count;
  EXPECT_EQ(count, 7u) << graph;  // two shards of three stages, and eliminate
}

TEST_F(ProcessorRun, TheEnvironmentConfiguresEmbree) {
  const std::string place =
      "'" BNVPL_BIN "/vpl-place' " + scene_ + " -n 100 --quiet -o " + path("c.vpl");
  const auto says = [&](const std::string& more) {
    const Outcome r = shell("env BNVPL_EMBREE_CONFIG=verbose=2 " + place + more);
    EXPECT_EQ(r.code, 0) << r.err;
    return contains(r.out + r.err, "Embree");
  };
  EXPECT_TRUE(says(""));
  EXPECT_FALSE(says(" --processor any")) << "which configures it itself";
}

}  // namespace
}  // namespace bnvpl
