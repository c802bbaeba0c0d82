// --strict, --no-clobber and --progress json.
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/pipeline/tool_runner.h"
#include "tools/common/process/exit_codes.h"

namespace bnvpl {
namespace {

class Strict : public PipelineTest {
 protected:
  // A scene of which a material has no effect, which is a warning.
  std::string sceneWithWarning() const {
    shell("cp -r scenes/cornell " + path("cornell"));
    const std::string file = "cornell/scene.toml";
    write(file, readAll(at(file)) + "\n[[material]]\nname = \"odd\"\nmodel = \"diffuse\"\n");
    return path(file);
  }
};

TEST_F(Strict, WarningsAreErrors) {
  const std::string arguments = sceneWithWarning() + " -n 100 --quiet -o " + path("c.vpl");
  const Outcome loose = tool("vpl-place", arguments);
  EXPECT_EQ(loose.code, kExitOk) << loose.err;
  EXPECT_TRUE(contains(loose.err, "warning: ")) << loose.err;
  fs::remove(at("c.vpl"));
  const Outcome strict = tool("vpl-place", arguments + " --strict");
  EXPECT_EQ(strict.code, kExitInput);
  EXPECT_EQ(strict.err,
            loose.err + "vpl-place: a warning is an error with --strict; nothing is written\n");
  EXPECT_FALSE(fs::exists(at("c.vpl")));
  EXPECT_EQ(tool("vpl-inspect", "scene " + path("cornell/scene.toml")).code, kExitOk);
  EXPECT_EQ(tool("vpl-inspect", "scene --strict " + path("cornell/scene.toml")).code, kExitInput);
  succeed("vpl-place", scene_ + " -n 100 --quiet --strict -o " + path("c.vpl"));
}

// A photon that comes to no VPL leaves an image of direct light, which is told.
TEST_F(Strict, VplsWithoutFluxAreAWarning) {
  succeed("vpl-place", scene_ + " -n 200 --quiet -o " + path("c.vpl"));
  succeed("vpl-eliminate", path("c.vpl") + " -n 1 --quiet -o " + path("v.vpl"));
  succeed("vpl-estimate", scene_ + " " + path("v.vpl") +
                              " --method guarded --photons 1 --quiet -o " + path("l.vpl"));
  const std::string arguments =
      scene_ + " " + path("l.vpl") + " --size 8x8 --spp 1 --quiet -o " + path("i.exr");
  const Outcome told = tool("vpl-render", arguments);
  EXPECT_EQ(told.code, kExitOk);
  EXPECT_TRUE(contains(told.err, "l.vpl: no VPL has flux")) << told.err;
  EXPECT_EQ(tool("vpl-render", arguments + " --strict").code, kExitInput);
}

TEST_F(Strict, OptionsWithoutEffectInTheSceneAreNamed) {
  makeStages(scene_);  // without near-specular surfaces
  const std::string render = "vpl-render", arguments = scene_ + " " + path("lit.vpl") +
                                                       " --size 8x8 --spp 1 --quiet -o " +
                                                       path("i.exr");
  for (const char* rays : {" --compensate none --near-field-rays 2", " --compensate near-field"}) {
    const Outcome told = tool(render, arguments + rays);
    EXPECT_EQ(told.code, kExitOk) << told.err;
    EXPECT_EQ(contains(told.err, "--near-field-rays had no effect"), contains(rays, "none"))
        << rays;
  }
  const Outcome adaptive =
      tool(render, scene_ + " --size 8x8 --passes 2 --integrator light --adaptive on --quiet -o " +
                       path("i.exr"));
  EXPECT_TRUE(contains(adaptive.err, "--adaptive had no effect")) << adaptive.err;
}

TEST_F(Strict, NoClobberKeepsWhatExists) {
  const std::string arguments = scene_ + " -n 100 --quiet --no-clobber -o " + path("c.vpl");
  succeed("vpl-place", arguments);
  const std::string before = readAll(at("c.vpl"));
  fail("vpl-place", arguments + " --seed 2", kExitOutput,
       {"c.vpl: exists, and --no-clobber keeps it; name another file for -o"});
  EXPECT_EQ(readAll(at("c.vpl")), before);
  const std::string exported = "export " + path("c.vpl") + " --no-clobber -o " + path("c.ply");
  succeed("vpl-inspect", exported + " --quiet");
  fail("vpl-inspect", exported, kExitOutput, {"c.ply: exists"});
  succeed("vpl-place", arguments + " --estimate >/dev/null");  // writes nothing
}

TEST_F(Strict, ProgressAsJson) {
  const Outcome placed =
      tool("vpl-place", scene_ + " -n 5k --quiet --progress json -o " + path("c.vpl"));
  ASSERT_EQ(placed.code, kExitOk) << placed.err;
  std::istringstream lines(placed.err);
  nlohmann::json last;
  for (std::string line; std::getline(lines, line);) {
    last = nlohmann::json::parse(line);
    EXPECT_EQ(last.size(), 6u) << line;
    EXPECT_GE(last.at("elapsed_s").get<double>(), 0.0);
    EXPECT_TRUE(last.contains("left_s"));
  }
  EXPECT_EQ(last.at("stage"), "vpl-place");
  EXPECT_EQ(last.at("phase"), "VPLs");
  EXPECT_EQ(last.at("total"), 5000);
  EXPECT_GE(last.at("done").get<int>(), 5000);
}

TEST_F(Strict, ProgressOfAMergeCountsItsRecords) {
  makeStages(scene_);
  const std::string render = scene_ + " --integrator path --spp 1 --quiet -o ";
  succeed("vpl-render", render + path("1.shard") + " --shard 1/2");
  succeed("vpl-render", render + path("2.shard") + " --shard 2/2");
  for (const char* output : {"whole.exr", "both.shard"}) {
    const Outcome merged = tool("vpl-merge", path("1.shard") + " " + path("2.shard") +
                                                 " --quiet --progress json -o " + path(output));
    ASSERT_EQ(merged.code, kExitOk) << merged.err;
    const std::string last = merged.err.substr(merged.err.rfind('{'));
    const auto json = nlohmann::json::parse(last);
    EXPECT_EQ(json.at("stage"), "vpl-merge");
    EXPECT_EQ(json.at("phase"), "records");
    EXPECT_GT(json.at("total").get<int>(), 1);
    EXPECT_EQ(json.at("done"), json.at("total"));
  }
}

// Every shard repeats the pilots of --method both, and counts them by its share.
TEST_F(Strict, ProgressOfAShardEndsAtItsShare) {
  makeStages(scene_);
  const Outcome part = tool("vpl-estimate", scene_ + " " + path("vpls.vpl") +
                                                " --photons 400k --shard 1/8 --quiet "
                                                "--progress json -o " +
                                                path("1.shard"));
  ASSERT_EQ(part.code, kExitOk) << part.err;
  std::istringstream lines(part.err);
  nlohmann::json last;
  for (std::string line; std::getline(lines, line);) {
    last = nlohmann::json::parse(line);
    // A shard may have a range of photons more than its share.
    EXPECT_LE(last.at("done").get<int>(), 1.01 * last.value("total", 50000)) << line;
  }
  EXPECT_EQ(last.at("total"), 50000);
  EXPECT_GT(last.at("done").get<int>(), 40000);
}

}  // namespace
}  // namespace bnvpl
