// Missing, foreign and damaged input, and output that cannot be written.
#include "tests/pipeline/tool_runner.h"
#include "tools/common/process/exit_codes.h"

namespace bnvpl {
namespace {

class Damage : public PipelineTest {
 protected:
  const std::string otherScene_ = "'" BNVPL_SOURCE "/scenes/test/two-patches.toml'";
};

TEST_F(Damage, MissingFilesAreNamed) {
  const std::string gone = path("gone.toml"), absent = path("absent.vpl"), out = " -o " + path("x");
  fail("vpl-place", gone + out, kExitInput, {"gone.toml"});
  fail("vpl-eliminate", absent + out + " -n 3", kExitInput, {"absent.vpl"});
  fail("vpl-estimate", scene_ + " " + absent + out, kExitInput, {"absent.vpl"});
  fail("vpl-render", scene_ + " " + absent + out, kExitInput, {"absent.vpl"});
  fail("vpl-render", gone + out + " --integrator path", kExitInput, {"gone.toml"});
  fail("vpl-inspect", "info " + absent, kExitInput, {"absent.vpl"});
  write("bare.toml",
        "[film]\nwidth = 4\nheight = 4\n[camera]\nposition = [0, 0, 1]\nlook_at = [0, 0, 0]\n"
        "vertical_fov_deg = 40\n[[mesh]]\nfile = \"lost.obj\"\n");
  fail("vpl-place", path("bare.toml") + out, kExitInput, {"lost.obj"});
  EXPECT_EQ(listing(), std::vector<std::string>{"bare.toml"});
}

TEST_F(Damage, WrongStageNamesTheToolToRun) {
  makeStages(scene_);
  const std::string out = " -o " + path("x");
  fail("vpl-eliminate", path("vpls.vpl") + out + " -n 5", kExitInput, {"vpls.vpl", "vpl-place"});
  fail("vpl-eliminate", path("lit.vpl") + out + " -n 5", kExitInput, {"lit.vpl", "vpl-place"});
  fail("vpl-estimate", scene_ + " " + path("candidates.vpl") + out, kExitInput,
       {"candidates.vpl", "vpl-eliminate"});
  fail("vpl-estimate", scene_ + " " + path("lit.vpl") + out, kExitInput, {"lit.vpl", "vpl-render"});
  fail("vpl-render", scene_ + " " + path("candidates.vpl") + out, kExitInput,
       {"candidates.vpl", "vpl-estimate"});
  fail("vpl-render", scene_ + " " + path("vpls.vpl") + out, kExitInput,
       {"vpls.vpl", "vpl-estimate"});
  EXPECT_EQ(listing(), (std::vector<std::string>{"candidates.vpl", "lit.vpl", "vpls.vpl"}));
}

TEST_F(Damage, ThingsThatAreNoVplFile) {
  write("text.vpl", "this is not it\n");
  write("empty.vpl", "");
  fs::create_directories(at("folder.vpl"));
  for (const char* name : {"text.vpl", "empty.vpl", "folder.vpl"}) {
    fail("vpl-eliminate", path(name) + " -n 1 -o " + path("x"), kExitInput, {name});
    fail("vpl-estimate", scene_ + " " + path(name) + " -o " + path("x"), kExitInput, {name});
    fail("vpl-render", scene_ + " " + path(name) + " -o " + path("x"), kExitInput, {name});
  }
  fail("vpl-place", path("text.vpl") + " -o " + path("x"), kExitInput, {"text.vpl"});
  fail("vpl-place", path("folder.vpl") + " -o " + path("x"), kExitInput, {"folder.vpl"});
}

TEST_F(Damage, ACutOrFlippedFileIsRefused) {
  makeStages(scene_);
  const std::string whole = readAll(at("lit.vpl"));
  write("cut.vpl", whole.substr(0, whole.size() - 1));
  std::string flipped = whole;
  flipped[flipped.size() / 2] = char(flipped[flipped.size() / 2] ^ 4);
  write("flipped.vpl", flipped);
  for (const char* name : {"cut.vpl", "flipped.vpl"}) {
    fail("vpl-render", scene_ + " " + path(name) + " -o " + path("x"), kExitInput, {name, "byte "});
  }
}

TEST_F(Damage, VplsOfAnotherSceneAreRefused) {
  makeStages(scene_);
  fail("vpl-estimate", otherScene_ + " " + path("vpls.vpl") + " -o " + path("x"), kExitInput,
       {"vpls.vpl", "another scene", "vpl-place"});
  fail("vpl-render", otherScene_ + " " + path("lit.vpl") + " -o " + path("x"), kExitInput,
       {"lit.vpl", "another scene", "vpl-place"});
  fail("vpl-inspect",
       "plot " + path("lit.vpl") + " --scene " + otherScene_ + " -o " + path("x.png"), kExitInput,
       {"another scene"});
  EXPECT_FALSE(fs::exists(at("x")));
}

TEST_F(Damage, MoreVplsThanCandidates) {
  makeStages(scene_);
  for (const char* way : {" -n 301", " -n 301 --estimate"}) {
    fail("vpl-eliminate", path("candidates.vpl") + " -o " + path("x") + way, kExitInput,
         {"candidates.vpl: ", "301", "300", "vpl-place"});
  }
  EXPECT_FALSE(fs::exists(at("x")));
  succeed("vpl-eliminate", path("candidates.vpl") + " -o " + path("x") + " -n 300");
}

// The commands that write each kind of output, without "-o".
std::vector<std::pair<std::string, std::string>> writers(const std::string& scene,
                                                         const std::string& candidates,
                                                         const std::string& vpls,
                                                         const std::string& lit) {
  return {{"vpl-place", scene + " -n 300"},
          {"vpl-place", scene + " -n 300 --method light"},
          {"vpl-eliminate", candidates + " -n 50"},
          {"vpl-estimate", scene + " " + vpls + " --photons 1k"},
          {"vpl-render", scene + " " + lit + " --spp 1"},
          {"vpl-render", scene + " --integrator path --spp 1"}};
}

TEST_F(Damage, UnwritableOutputLeavesNothing) {
  makeStages(scene_);
  fs::create_directories(at("folder"));
  const std::vector<std::string> before = listing();
  for (const auto& [name, arguments] :
       writers(scene_, path("candidates.vpl"), path("vpls.vpl"), path("lit.vpl"))) {
    fail(name, arguments + " -o " + path("absent/x"), kExitOutput, {"absent/x"});
    fail(name, arguments + " -o " + path("folder"), kExitOutput, {"folder"});
    fail(name, arguments + " -o /dev/full", kExitOutput, {"/dev/full"});
    EXPECT_EQ(listing(), before) << name;
  }
  for (const char* option : {"--stats", "--depfile"}) {
    fail("vpl-place", scene_ + " -n 5 -o " + path("x") + " " + option + " " + path("absent/y"),
         kExitOutput, {"absent/y"});
  }
}

// The disk fills up during the write: the old file stays.
TEST_F(Damage, OldOutputSurvivesAFailedWrite) {
  makeStages(scene_);
  for (const auto& [name, arguments] :
       writers(scene_, path("candidates.vpl"), path("vpls.vpl"), path("lit.vpl"))) {
    write("old", "");  // empty, like a file of mktemp
    const std::vector<std::string> before = listing();
    fail(name, arguments + " -o " + path("old"), kExitOutput, {"old"},
         "trap '' XFSZ; ulimit -f 1;");
    EXPECT_EQ(readAll(at("old")), "") << name;
    EXPECT_EQ(listing(), before) << name;
  }
}

TEST_F(Damage, OldOutputSurvivesBadInput) {
  makeStages(scene_);
  write("bad.vpl", "bad");
  const std::string lit = readAll(at("lit.vpl"));
  fail("vpl-estimate", scene_ + " " + path("bad.vpl") + " -o " + path("lit.vpl"), kExitInput);
  fail("vpl-estimate", otherScene_ + " " + path("vpls.vpl") + " -o " + path("lit.vpl"), kExitInput);
  fail("vpl-estimate", scene_ + " " + path("vpls.vpl") + " --photons none -o " + path("lit.vpl"),
       kExitUsage);
  EXPECT_EQ(readAll(at("lit.vpl")), lit);
}

// An image and its preview belong together: neither is left without the other.
TEST_F(Damage, UnwritablePreviewLeavesNoImage) {
  fail("vpl-render",
       scene_ + " --integrator path --spp 1 -o " + path("x.exr") + " --png " + path("absent/x.png"),
       kExitOutput, {"absent/x.png"});
  EXPECT_TRUE(listing().empty());
}

TEST_F(Damage, AViewOfNothingIsRefusedInBoundedTime) {
  fs::copy(BNVPL_SOURCE "/scenes/test", at("test"), fs::copy_options::recursive);
  std::string toml = readAll(at("test/one-bounce.toml"));
  const size_t where = toml.find("look_at = [-0.2, 0.4, 0.0]");
  ASSERT_NE(where, std::string::npos);
  write("test/void.toml", toml.replace(where, 26, "look_at = [0.3, 1.2, 99.0]"));
  fail("vpl-place", path("test/void.toml") + " -n 10 -o " + path("x"), kExitInput,
       {"void.toml: only 0 of 10", "100 % left the scene", "paths", "camera"});
  EXPECT_FALSE(fs::exists(at("x")));
}

TEST_F(Damage, ASceneWithoutLightIsRefused) {
  makeStages(scene_);
  write(
      "dark.obj",
      "mtllib dark.mtl\nusemtl grey\nv -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 2 -1\nf 1 3 2\nf 1 2 4\n");
  write("dark.mtl", "newmtl grey\nKd 0.5 0.5 0.5\n");
  write("dark.toml",
        "[film]\nwidth = 4\nheight = 4\n[camera]\nposition = [0, 1, 3]\nlook_at = [0, 0.5, 0]\n"
        "vertical_fov_deg = 40\n[[mesh]]\nfile = \"dark.obj\"\n");
  succeed("vpl-place", path("dark.toml") + " -n 30 -o " + path("c.vpl"));
  succeed("vpl-eliminate", path("c.vpl") + " -n 5 -o " + path("v.vpl"));
  fail("vpl-estimate",
       path("dark.toml") + " " + path("v.vpl") + " --photons 100 -o " + path("l.vpl"), kExitInput,
       {"dark.toml: has no light"});
  fail("vpl-place", path("dark.toml") + " --method light -n 30 -o " + path("l.vpl"), kExitInput,
       {"no light"});
}

}  // namespace
}  // namespace bnvpl
