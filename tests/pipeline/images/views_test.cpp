// VPLs that serve several views of one scene: their placement, and checks of the views that they
// were placed for.
#include "formats/vpl/vpl_io.h"
#include "tests/pipeline/tool_runner.h"
#include "tools/common/process/exit_codes.h"

namespace bnvpl {
namespace {

class Views : public PipelineTest {
 protected:
  void SetUp() override {
    writeView("own", 64, "[0.3, 1.2, 3.2]", 50);
    writeView("a", 32, "[0.3, 1.2, 3.2]", 50);
    writeView("b", 32, "[-0.3, 0.8, 2.9]", 40);
    writeView("c", 32, "[0.1, 0.7, 2.5]", 60);
  }
  void writeView(const std::string& name, int width, const std::string& position, int fov) const {
    write(name + ".toml", "[film]\nwidth = " + std::to_string(width) + "\nheight = " +
                              std::to_string(width * 3 / 4) + "\n[camera]\nposition = " + position +
                              "\nlook_at = [-0.2, 0.4, 0.0]\nup = [0.0, 1.0, 0.0]\n"
                              "vertical_fov_deg = " +
                              std::to_string(fov) + ".0\n");
  }
  std::string by(const std::string& names) const {
    std::string words;
    for (const char name : names) words += " --view " + path(std::string(1, name) + ".toml");
    return words;
  }
  void expectTheSame(const std::string& a, const std::string& b) const {
    EXPECT_TRUE(readAll(at(a)) == readAll(at(b))) << a << " and " << b;
  }
};

TEST_F(Views, OneViewByItsFileIsTheScenesOwn) {
  const std::string place = scene_ + " -n 3k --quiet -o ";
  succeed("vpl-place", place + path("own.vpl"));
  succeed("vpl-place", place + path("view.vpl") + " --view " + path("own.toml"));
  succeed("vpl-place",
          place + path("share.vpl") + " --view " + path("own.toml") + " --view-shares 3");
  expectTheSame("own.vpl", "view.vpl");
  expectTheSame("own.vpl", "share.vpl");
}

TEST_F(Views, GiveTheSameBytesInShardsWithThreadsAndCheckpoints) {
  const std::string place = scene_ + by("abc") + " --view-shares 3,1,2 -n 40k --quiet -o ";
  succeed("vpl-place", place + path("whole.vpl"));
  succeed("vpl-place", place + path("one.vpl") + " --threads 1");
  succeed("vpl-place",
          place + path("saved.vpl") + " --checkpoint-every 0 --checkpoint " + path("s"));
  std::string shards;
  for (const char* part : {"1", "2", "3"}) {
    shards += " " + path(part + std::string(".shard"));
    succeed("vpl-place", place + path(part + std::string(".shard")) + " --shard " + part + "/3");
  }
  succeed("vpl-merge", shards + " --quiet -o " + path("merged.vpl"));
  for (const char* file : {"one.vpl", "saved.vpl", "merged.vpl"}) expectTheSame(file, "whole.vpl");
  const Outcome r =
      tool("vpl-place", place.substr(0, place.find(" --quiet")) + " -o " + path("x.vpl"));
  EXPECT_TRUE(contains(r.out, "3 views, of each ")) << r.out;
  // Shares are relative, and the order of views matters.
  succeed("vpl-place", scene_ + by("ab") + " --view-shares 1,3 -n 3k --quiet -o " + path("ab.vpl"));
  succeed("vpl-place", scene_ + by("ba") + " --view-shares 1,3 -n 3k --quiet -o " + path("ba.vpl"));
  EXPECT_NE(readVpl(at("ab.vpl")).position, readVpl(at("ba.vpl")).position);
}

TEST_F(Views, ACheckpointOfOthersIsRefused) {
  const std::string place = scene_ + " -n 100M -o " + path("x.vpl") + " --checkpoint " + path("c");
  interrupt("vpl-place", place + by("ab") + " --quiet", "c");
  fail("vpl-place", place + by("ac"), kExitInput, {"another run", "views 2 hash was"});
  fail("vpl-place", place + by("ab") + " --view-shares 2,1", kExitInput, {"views 1 share was 1"});
  fail("vpl-place", place + by("abc"), kExitInput, {"views had 2 entries and has now 3"});
}

TEST_F(Views, WhatMeansNothingIsRefused) {
  const std::string place = scene_ + " -n 300 -o " + path("x.vpl");
  for (const char* shares : {"1", "1,1,1"}) {
    fail("vpl-place", place + by("ab") + " --view-shares " + shares, kExitUsage,
         {"--view-shares", "for 2 views"});
  }
  for (const char* shares : {"1,0", "1,", "a,1", "1.5,1", "65536,1", "1,-1"}) {
    fail("vpl-place", place + by("ab") + " --view-shares " + shares, kExitUsage,
         {"--view-shares", "whole numbers"});
  }
  fail("vpl-place", place + by("ab") + " --method light", kExitUsage, {"asks for no view"});
  fail("vpl-place", place + by("ad"), kExitInput, {"d.toml", "no such file"});
  makeStages(scene_);
  fail("vpl-render", scene_ + " " + path("lit.vpl") + by("ab") + " -o " + path("x.exr"), kExitUsage,
       {"--view", "given more than once"});
  EXPECT_FALSE(fs::exists(at("x.vpl")));
}

// VPLs belong to every view that they were placed for; an image belongs to one.
TEST_F(Views, ChecksKnowWhomVplsWerePlacedFor) {
  succeed("vpl-place", scene_ + by("ab") + " -n 300 --quiet -o " + path("candidates.vpl"));
  succeed("vpl-eliminate", path("candidates.vpl") + " -n 60 --quiet -o " + path("vpls.vpl"));
  succeed("vpl-estimate",
          scene_ + " " + path("vpls.vpl") + " --photons 2k --quiet -o " + path("lit.vpl"));
  const std::string files = path("candidates.vpl") + " " + path("vpls.vpl") + " " + path("lit.vpl");
  for (const std::string view : {"a", "b", "c"}) {
    const std::string image = path(view + ".exr"), of = " --scene " + scene_ + by(view);
    succeed("vpl-render",
            scene_ + " " + path("lit.vpl") + by(view) + " --spp 1 --quiet -o " + image);
    const Outcome r = tool("vpl-inspect", "check --deep " + files + " " + image + of);
    EXPECT_EQ(r.code, kExitOk) << r.err;
    EXPECT_EQ(contains(r.out, "placed for another view"), view == "c") << r.out;
    EXPECT_EQ(contains(r.out, "(theirs: views 32x24 "), view == "c") << r.out;
  }
  for (const char* deep : {"", "--deep "}) {
    fail("vpl-inspect",
         std::string("check --quiet ") + deep + files + " " + path("a.exr") + " --scene " + scene_ +
             by("b"),
         kExitInput, {"a.exr: vpl-render looked at another view than that of "});
  }
  const Outcome info = tool("vpl-inspect", "info " + path("lit.vpl"));
  EXPECT_TRUE(contains(info.out, "; views 32x24 ")) << info.out;
  std::string many;
  for (int i = 0; i < 6; ++i) many += by("abc");
  succeed("vpl-place", scene_ + many + " -n 300 --quiet -o " + path("many.vpl"));
  EXPECT_TRUE(contains(tool("vpl-inspect", "info " + path("many.vpl")).out, " and 14 more"));
}

}  // namespace
}  // namespace bnvpl
