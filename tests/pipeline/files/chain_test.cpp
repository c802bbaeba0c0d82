// vpl-inspect check --deep on files that the stages wrote.
#include "formats/image/exr_io.h"
#include "tests/pipeline/tool_runner.h"
#include "tools/common/process/exit_codes.h"

namespace bnvpl {
namespace {

class Chain : public PipelineTest {
 protected:
  void SetUp() override {
    makeStages(scene_);
    succeed("vpl-render",
            scene_ + " " + path("lit.vpl") + " -o " + path("image.exr") +
                " --size 24x16 --spp 2 --layers N,direct,CryptoObject --compensate none");
  }
  std::string all() const {
    return "check --deep " + path("candidates.vpl") + " " + path("vpls.vpl") + " " +
           path("lit.vpl") + " " + path("image.exr");
  }
};

TEST_F(Chain, AWholeOnePasses) {
  const Outcome r = tool("vpl-inspect", all() + " --scene " + scene_);
  EXPECT_EQ(r.code, kExitOk) << r.err;
  EXPECT_TRUE(contains(r.out, "one whole chain")) << r.out;
}

// The commands in the message, run literally, repair the chain and change nothing that was right.
TEST_F(Chain, TheCommandsOfTheMessageRepairIt) {
  const std::string image = readAll(at("image.exr"));
  const std::vector<float> red = *readExr(at("image.exr")).find("R");
  succeed("vpl-place", scene_ + " -o " + path("candidates.vpl") + " -n 300 --seed 2");
  Outcome r = tool("vpl-inspect", all() + " --quiet --scene " + scene_);
  EXPECT_EQ(r.code, kExitInput);
  const size_t run = r.err.find("; run: ");
  ASSERT_NE(run, std::string::npos) << r.err;
  const std::string commands = r.err.substr(run + 7);
  EXPECT_TRUE(contains(commands, "vpl-eliminate ")) << commands;
  write("mend.sh", "PATH='" BNVPL_BIN "':$PATH\n" + commands);
  r = shell("bash -e " + path("mend.sh"));
  ASSERT_EQ(r.code, 0) << commands << r.err;
  EXPECT_EQ(tool("vpl-inspect", all() + " --scene " + scene_).code, kExitOk);
  EXPECT_NE(*readExr(at("image.exr")).find("R"), red);
  // With the first candidates and the same commands for the rest, the first image returns.
  succeed("vpl-place", scene_ + " -o " + path("candidates.vpl") + " -n 300");
  ASSERT_EQ(shell("bash -e " + path("mend.sh")).code, 0);
  EXPECT_EQ(readAll(at("image.exr")), image);
}

TEST_F(Chain, TheCommandsHaveTheOptionsOfTheScene) {
  write("view.toml",
        "[film]\nwidth = 24\nheight = 16\n[camera]\nposition = [0.3, 1.2, 3.2]\nlook_at = [-0.2, "
        "0.4, 0.0]\nup = [0.0, 1.0, 0.0]\nvertical_fov_deg = 50.0\n");
  const std::string view = " --view " + path("view.toml"), scene = " --scene " + scene_ + view;
  succeed("vpl-render", scene_ + view + " " + path("lit.vpl") + " -o " + path("image.exr"));
  ASSERT_EQ(tool("vpl-inspect", all() + scene).code, kExitOk);
  succeed("vpl-place", scene_ + " -o " + path("candidates.vpl") + " -n 300 --seed 2");
  const Outcome r = tool("vpl-inspect", all() + " --quiet" + scene);
  const size_t run = r.err.find("; run: ");
  ASSERT_NE(run, std::string::npos) << r.err;
  write("mend.sh", "PATH='" BNVPL_BIN "':$PATH\n" + r.err.substr(run + 7));
  ASSERT_EQ(shell("bash -e " + path("mend.sh")).code, 0) << r.err;
  EXPECT_EQ(tool("vpl-inspect", all() + scene).code, kExitOk);
}

TEST_F(Chain, AnotherSceneAMissingStageAndATwinAreRefused) {
  fail("vpl-inspect",
       all() + " --quiet --scene " + "'" BNVPL_SOURCE "/scenes/veach-door/scene.toml'", kExitInput,
       {"candidates.vpl: made from scene", "; run: vpl-place "});
  fail("vpl-inspect", "check --deep --quiet " + path("candidates.vpl") + " " + path("lit.vpl"),
       kExitInput, {"lit.vpl: was made from vpls ", "not among the files"});
  fail("vpl-inspect",
       "check --deep --quiet " + path("candidates.vpl") + " " + path("candidates.vpl"), kExitInput,
       {"same stage"});
}

TEST_F(Chain, APathTracedImageIsAChainOfItsOwn) {
  succeed("vpl-render", scene_ + " --integrator path -o " + path("p.exr") + " --size 8x8 --spp 1");
  succeed("vpl-inspect", "check --deep --quiet " + path("p.exr"));
}

}  // namespace
}  // namespace bnvpl
