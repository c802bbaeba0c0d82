// VPLs from the lights and view-dependent rejection: no vpl-estimate, two lit files.
#include "formats/vpl/vpl_io.h"
#include "tests/pipeline/tool_runner.h"
#include "tools/common/process/exit_codes.h"

namespace bnvpl {
namespace {

class RejectionChain : public PipelineTest {
 protected:
  void SetUp() override {
    fs::copy(BNVPL_SOURCE "/scenes/test", at("s"), fs::copy_options::recursive);
    succeed("vpl-place", mine_ + " --method light -n 500 -o " + path("light.vpl"));
    succeed("vpl-eliminate", path("light.vpl") + " -n 50 --method rejection --scene " + mine_ +
                                 " -o " + path("rj.vpl"));
    succeed("vpl-render",
            mine_ + " " + path("rj.vpl") + " --size 24x16 --spp 1 -o " + path("rj.exr"));
  }
  // Edits the scene file so that only its camera changes.
  void turnCamera() const {
    std::string toml = readAll(at("s/one-bounce.toml"));
    const size_t where = toml.find("vertical_fov_deg = ");
    ASSERT_NE(where, std::string::npos);
    write("s/one-bounce.toml", toml.replace(where, 19, "vertical_fov_deg = 1"));
  }
  const std::string mine_ = path("s/one-bounce.toml");
  const std::string files_ = path("light.vpl") + " " + path("rj.vpl") + " " + path("rj.exr");
};

TEST_F(RejectionChain, IsOneWholeChain) {
  const Outcome r = tool("vpl-inspect", "check --deep " + files_ + " --scene " + mine_);
  EXPECT_EQ(r.code, kExitOk) << r.err;
  EXPECT_TRUE(contains(r.out, "one whole chain")) << r.out;
  succeed("vpl-inspect", "check " + files_);
  succeed("vpl-inspect",
          "check " + path("light.vpl") + " " + path("rj.exr"));  // the file between them is missing
}

TEST_F(RejectionChain, VplsOfVplEstimateAreRefused) {
  makeStages(mine_);
  fail("vpl-eliminate",
       path("lit.vpl") + " -n 5 --method rejection --scene " + mine_ + " -o " + path("x.vpl"),
       kExitInput, {"vpl-place --method light", "vpl-estimate"});
}

// Rejection may scale the flux of a VPL by one factor; any other change is refused.
TEST_F(RejectionChain, RowsThatWereTouchedAreRefused) {
  const VplTable right = readVpl(at("rj.vpl"));
  const auto refused = [&](const VplTable& table) {
    writeVpl(at("rj.vpl"), table);
    fail("vpl-inspect", "check --deep --quiet " + path("light.vpl") + " " + path("rj.vpl"),
         kExitInput, {"rj.vpl: row 0 (id ", "is not that of", "; run: vpl-eliminate "});
  };
  VplTable wrong = right;
  wrong.flux[0].x *= 0.9f;
  wrong.firstBounceFlux[0] = {};
  refused(wrong);
  wrong = right;
  wrong.flux[0] *= 1e-4f;  // rejection never reduces flux
  wrong.firstBounceFlux[0] *= 1e-4f;
  refused(wrong);
  wrong = right;
  wrong.position[0].x += 0.01f;
  refused(wrong);
}

TEST_F(RejectionChain, AnotherViewIsRefused) {
  turnCamera();
  const std::string by = " --scene " + mine_, problem = " looked at another view than that of ";
  fail("vpl-inspect", "check --quiet " + path("rj.exr") + by, kExitInput,
       {"rj.exr: vpl-eliminate" + problem, "; rerun vpl-eliminate and every later stage"});
  fail("vpl-inspect", "check --deep --quiet " + files_ + by, kExitInput,
       {"rj.vpl: vpl-eliminate" + problem, "; run: vpl-eliminate ", " && vpl-render "});
  // Photons do not depend on the camera.
  const Outcome r = tool("vpl-inspect", "check " + path("light.vpl") + by);
  EXPECT_EQ(r.code, kExitOk) << r.err;
  EXPECT_FALSE(contains(r.out, "another view")) << r.out;
}

TEST_F(RejectionChain, PlacedVplsMayBeOfAnotherViewAndImagesMayNot) {
  makeStages(mine_);
  const std::string render = " " + path("lit.vpl") + " --spp 1 --size 8x8 -o " + path("i.exr");
  const std::string all = path("candidates.vpl") + " " + path("vpls.vpl") + " " + path("lit.vpl") +
                          " " + path("i.exr") + " --scene " + mine_;
  succeed("vpl-render", mine_ + render);
  EXPECT_FALSE(contains(tool("vpl-inspect", "check --deep " + all).out, "another view"));
  turnCamera();
  for (const char* deep : {"", "--deep "}) {
    fail("vpl-inspect", std::string("check --quiet ") + deep + all, kExitInput,
         {"i.exr: vpl-render looked at another view than that of ", "run"});
  }
  succeed("vpl-render", mine_ + render);
  const Outcome r = tool("vpl-inspect", "check --deep " + all);
  EXPECT_EQ(r.code, kExitOk) << r.err;
  EXPECT_TRUE(contains(r.out, "placed for another view, which is no error")) << r.out;
}

TEST_F(RejectionChain, InfoShowsTheView) {
  EXPECT_TRUE(contains(tool("vpl-inspect", "info " + path("rj.exr")).out, "; view 24x16 "));
  EXPECT_TRUE(contains(tool("vpl-inspect", "info " + path("rj.vpl")).out, "; view 64x48 "));
  EXPECT_FALSE(contains(tool("vpl-inspect", "info " + path("light.vpl")).out, "; view"));
}

// Neither method leaves work to vpl-estimate.
TEST_F(RejectionChain, ThePipelinesRefuseIt) {
  const std::string out = path("out");
  for (const char* flags : {"PLACE_FLAGS='--depth 3 --method light'", "PLACE_FLAGS=--method=light",
                            "ELIMINATE_FLAGS='--method rejection'"}) {
    const Outcome r = shell(std::string("make -f pipelines/Makefile OUT=") + out + " " + flags);
    EXPECT_NE(r.code, 0);
    EXPECT_TRUE(contains(r.err, "leave no work to vpl-estimate")) << r.err;
  }
  for (const char* flags :
       {"--place-flags='--method light'", "--eliminate-flags='--method rejection'"}) {
    const Outcome r = shell("pipelines/generate_ninja.py " + mine_ + " --out " + out + " " + flags);
    EXPECT_NE(r.code, 0);
    EXPECT_TRUE(contains(r.err, "leave no work to vpl-estimate")) << r.err;
  }
  EXPECT_FALSE(fs::exists(at("out")));
}

}  // namespace
}  // namespace bnvpl
