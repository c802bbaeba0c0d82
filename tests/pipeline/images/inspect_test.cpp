// vpl-inspect on files that the stages wrote: check --scene, and --stats of commands that print.
#include "tests/pipeline/tool_runner.h"
#include "tools/common/files/json_text.h"
#include "tools/common/process/exit_codes.h"

namespace bnvpl {
namespace {

class Inspect : public PipelineTest {
 protected:
  void SetUp() override {
    makeStages(scene_);
    succeed("vpl-render", scene_ + " " + path("lit.vpl") + " --spp 1 -o " + path("image.exr"));
  }
  // The --stats summary of a command that ends with `code`; expects the same output as without it.
  Json stats(const std::string& command, int code = kExitOk) const {
    const Outcome with = tool("vpl-inspect", command + " --stats " + path("s.json"));
    EXPECT_EQ(with.code, code) << with.err;
    EXPECT_EQ(with.out, tool("vpl-inspect", command).out);
    Json json = Json::parse(readAll(at("s.json")), nullptr, false);
    EXPECT_EQ(json["tool"], "vpl-inspect") << json;
    EXPECT_TRUE(std::string(json["version"]).starts_with(BNVPL_VERSION "+"));
    EXPECT_GT(json["peak_memory_MiB"].get<double>(), 1.0);
    EXPECT_GE(json["time_s"].get<double>(), 0.0);
    fs::remove(at("s.json"));
    return json;
  }
  const std::string files_ =
      path("candidates.vpl") + " " + path("lit.vpl") + " " + path("image.exr");
  const std::string other_ = "'" BNVPL_SOURCE "/scenes/test/two-patches.toml'";
};

TEST_F(Inspect, CheckUsesTheSceneWithAndWithoutDeep) {
  const Outcome r = tool("vpl-inspect", "check " + files_ + " --scene " + scene_);
  EXPECT_EQ(r.code, kExitOk) << r.err;
  EXPECT_TRUE(contains(r.out, "one-bounce.toml as it is now")) << r.out;
  for (const char* name : {"candidates.vpl", "lit.vpl", "image.exr"}) {
    fail("vpl-inspect", "check --quiet " + path(name) + " --scene " + other_, kExitInput,
         {std::string(name) + ": made from scene ", "two-patches.toml is ", "rerun vpl-place"});
  }
  fail("vpl-inspect", "check --quiet " + files_ + " --scene " + path("gone.toml"), kExitInput,
       {"gone.toml"});
  fail("vpl-inspect", "check --quiet " + files_ + " --define A=b", kExitUsage,
       {"--define", "--scene"});
}

TEST_F(Inspect, CheckNoticesAChangedMaterial) {
  fs::copy(BNVPL_SOURCE "/scenes/test", at("scene"), fs::copy_options::recursive);
  const std::string copy = path("scene/one-bounce.toml");
  succeed("vpl-inspect", "check " + files_ + " --scene " + copy);
  write("scene/one-bounce.mtl", readAll(at("scene/one-bounce.mtl")) + "newmtl last\nKd 1 0 0\n");
  succeed("vpl-inspect", "check " + files_ + " --scene " + copy);  // a material of no face
  std::string mtl = readAll(at("scene/one-bounce.mtl"));
  const size_t where = mtl.find("Kd 0.");
  ASSERT_NE(where, std::string::npos);
  mtl[where + 5] = mtl[where + 5] == '1' ? '2' : '1';
  write("scene/one-bounce.mtl", mtl);
  fail("vpl-inspect", "check --quiet " + files_ + " --scene " + copy, kExitInput,
       {"candidates.vpl: made from scene "});
}

TEST_F(Inspect, TheWrongFileIsReportedWithItsRemedy) {
  fail("vpl-inspect", "info " + path("nix"), kExitInput,
       {"nix: cannot open: No such file or directory; check the name, or run the stage"});
  fail("vpl-inspect", "info " + path(""), kExitInput, {": is a folder; name a .vpl"});
  fail("vpl-inspect", "compare " + path("image.exr") + " " + path("lit.vpl"), kExitInput,
       {"lit.vpl: is a .vpl file, not an image"});
  fail("vpl-inspect", "compare " + path("nix") + " " + path("image.exr"), kExitInput,
       {"nix: cannot open: "});
}

TEST_F(Inspect, ExportTakesUpperCase) {
  for (const std::string name : {"x.ply", "x.PLY", "x.csv", "x.CSV"})
    succeed("vpl-inspect", "export " + path("lit.vpl") + " -o " + path(name));
  EXPECT_TRUE(readAll(at("x.ply")) == readAll(at("x.PLY")));
  EXPECT_TRUE(readAll(at("x.csv")) == readAll(at("x.CSV")));
}

TEST_F(Inspect, ThePixelTypeIsInTheHistory) {
  succeed("vpl-render",
          scene_ + " " + path("lit.vpl") + " --spp 1 --pixels half -o " + path("half.exr"));
  EXPECT_TRUE(contains(tool("vpl-inspect", "info " + path("half.exr")).out, "pixels half"));
  EXPECT_TRUE(contains(tool("vpl-inspect", "info " + path("image.exr")).out, "pixels float"));
}

TEST_F(Inspect, StatsOfInfo) {
  const Json json = stats("info --json " + path("lit.vpl"));
  EXPECT_EQ(json["info"]["rows"], 60);
  EXPECT_EQ(json["info"], Json::parse(tool("vpl-inspect", "info --json " + path("lit.vpl")).out));
  EXPECT_EQ(stats("info " + path("image.exr"))["info"]["format"], "exr");
}

TEST_F(Inspect, StatsOfCheck) {
  const Json json = stats("check --scene " + scene_ + " " + files_)["check"];
  ASSERT_EQ(json["files"].size(), 3u) << json;
  EXPECT_TRUE(contains(json["files"][1]["file"], "lit.vpl")) << json;
  EXPECT_EQ(json["files"][1]["what"], "lit, 60 rows");
  for (const Json& file : json["files"]) EXPECT_EQ(file["scene"], json["scene"]) << json;
  EXPECT_EQ(json["deep"], false);
  EXPECT_EQ(stats("check --quiet --deep " + path("candidates.vpl"))["check"]["deep"], true);
}

TEST_F(Inspect, StatsOfCompare) {
  const std::string both = "compare " + path("image.exr") + " " + path("image.exr");
  const Json json = stats(both)["compare"];
  EXPECT_EQ(json["rmse"], 0.0);
  EXPECT_EQ(json, Json::parse(tool("vpl-inspect", both + " --json").out));
  succeed("vpl-render",
          scene_ + " " + path("lit.vpl") + " --spp 1 --seed 2 -o " + path("other.exr"));
  const std::string unlike = "compare " + path("image.exr") + " " + path("other.exr");
  EXPECT_EQ(stats(unlike + " --max-rmse 0", kExitDifferent)["compare"]["within_limits"], false);
}

// A failure leaves neither a summary nor a picture.
TEST_F(Inspect, FailuresWriteNothing) {
  write("bad.vpl", "bad");
  const std::vector<std::string> before = listing();
  const std::string stats = " --stats " + path("s.json");
  fail("vpl-inspect", "info " + path("bad.vpl") + stats, kExitInput, {"bad.vpl"});
  fail("vpl-inspect", "check --quiet " + path("bad.vpl") + stats, kExitInput, {"bad.vpl"});
  fail("vpl-inspect",
       "compare " + path("image.exr") + " " + path("bad.vpl") + stats + " --diff " + path("d.png"),
       kExitInput, {"bad.vpl"});
  fail("vpl-inspect", "info " + path("lit.vpl") + " --stats " + path("absent/s"), kExitOutput,
       {"absent/s"});
  EXPECT_EQ(listing(), before);
}

}  // namespace
}  // namespace bnvpl
