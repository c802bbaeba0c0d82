// The executable itself: its exit codes, files and printed output.
#include "scene/load_scene.h"
#include "tests/inspect/run_inspect.h"
#include "tests/inspect/tiny_scene.h"
#include "tools/common/run/exit_codes.h"

namespace bnvpl {
namespace {

class Cli : public InspectTest {
 protected:
  std::string path(const std::string& name) const { return "'" + at(name).string() + "'"; }
};

TEST_F(Cli, InfoAsTextAndJson) {
  writeVpl(at("lit.vpl"), threeRows(VplStage::Lit));
  const Outcome text = runInspect("info " + path("lit.vpl"));
  EXPECT_EQ(text.code, kExitOk) << text.output;
  EXPECT_TRUE(contains(text.output, "lit, 3 rows"));
  const Outcome json = runInspect("info --json " + path("lit.vpl"));
  EXPECT_EQ(json.code, kExitOk);
  EXPECT_EQ(Json::parse(json.output)["energy_W"]["R"], 1.5);
}

TEST_F(Cli, DamagedFilesExitWith3) {
  writeVpl(at("lit.vpl"), threeRows(VplStage::Lit));
  std::string bytes = readAll(at("lit.vpl"));
  bytes[bytes.size() - 100] ^= 1;
  writeAll(at("bad.vpl"), bytes);
  for (const char* command : {"info ", "check "}) {
    const Outcome result = runInspect(command + path("bad.vpl"));
    EXPECT_EQ(result.code, kExitInput);
    EXPECT_TRUE(contains(result.output, "bad.vpl: byte ")) << result.output;
  }
  const Outcome mixed = runInspect("check " + path("lit.vpl") + " " + path("bad.vpl"));
  EXPECT_EQ(mixed.code, kExitInput);
  EXPECT_TRUE(contains(mixed.output, "lit.vpl: OK")) << mixed.output;
  EXPECT_EQ(runInspect("info " + path("absent.vpl")).code, kExitInput);
}

TEST_F(Cli, UsageErrorsExitWith2) {
  writeVpl(at("lit.vpl"), threeRows(VplStage::Lit));
  EXPECT_EQ(runInspect("").code, kExitUsage);
  EXPECT_EQ(runInspect("paint " + path("lit.vpl")).code, kExitUsage);
  EXPECT_EQ(runInspect("info").code, kExitUsage);
  EXPECT_EQ(runInspect("info --nothing " + path("lit.vpl")).code, kExitUsage);
  EXPECT_EQ(runInspect("export " + path("lit.vpl") + " -o " + path("a.stl")).code, kExitUsage);
  EXPECT_EQ(runInspect("export /absent.vpl -o " + path("a.stl")).code,
            kExitUsage);  // refused before the input is read
  EXPECT_EQ(runInspect("--help").code, kExitOk);
  EXPECT_EQ(runInspect("compare --help").code, kExitOk);
  EXPECT_TRUE(contains(runInspect("--version").output, "vpl-inspect " BNVPL_VERSION));
}

TEST_F(Cli, ExportsAndRefusesAnUnwritableOutput) {
  writeVpl(at("lit.vpl"), threeRows(VplStage::Lit));
  EXPECT_EQ(runInspect("export --quiet " + path("lit.vpl") + " -o " + path("a.ply")).output, "");
  EXPECT_TRUE(fs::exists(at("a.ply")));
  EXPECT_EQ(runInspect("export " + path("lit.vpl") + " -o " + path("absent/a.ply")).code,
            kExitOutput);
}

TEST_F(Cli, CompareExitsWith5BeyondALimit) {
  writeExr(at("a.exr"), flatImage(4, 3, 3, 3, 3), ExrPixelType::Float);
  writeExr(at("b.exr"), flatImage(4, 3, 2, 2, 2), ExrPixelType::Float);
  const std::string both = "compare " + path("a.exr") + " " + path("b.exr");
  EXPECT_EQ(runInspect(both).code, kExitOk);
  EXPECT_TRUE(contains(runInspect(both).output, "epsilon 0.0004 = 0.0001 times"));
  EXPECT_EQ(runInspect(both + " --max-relmse 0.3").code, kExitOk);
  EXPECT_EQ(runInspect(both + " --max-relmse 0.2").code, kExitDifferent);
  EXPECT_EQ(runInspect(both + " --max-rmse 0.9").code, kExitDifferent);
  EXPECT_EQ(runInspect(both + " --max-rmse-over-mean 0.6").code, kExitOk);
  EXPECT_EQ(runInspect(both + " --layer indirect").code, kExitInput);
  const Outcome json = runInspect(both + " --json --diff " + path("d.png"));
  EXPECT_DOUBLE_EQ(Json::parse(json.output)["rmse_over_mean"].get<double>(), 0.5);
  EXPECT_EQ(readAll(at("d.png")).substr(1, 3), "PNG");
}

TEST_F(Cli, CompareTakesALayerOfEachImage) {
  writeExr(at("a.exr"), flatImage(1, 1, 2, 2, 2), ExrPixelType::Float);
  Image b = flatImage(1, 1, 9, 9, 9);
  for (const char* name : {"indirect.R", "indirect.G", "indirect.B"}) b.add(name) = {2};
  writeExr(at("b.exr"), b, ExrPixelType::Float);
  const std::string both = "compare " + path("a.exr") + " " + path("b.exr") + " --max-rmse 0";
  EXPECT_EQ(runInspect(both + " --layer-b indirect").code, kExitOk);
  EXPECT_EQ(runInspect(both).code, kExitDifferent);
}

TEST_F(Cli, PlotsWithTheSameBytesForAnyThreadCount) {
  writeTinyScene(at(""));
  const Scene scene = loadScene(at("tiny.toml"));
  writeVpl(at("rows.vpl"), tinyRows(scene.contentHash));
  const std::string plot = "plot " + path("rows.vpl") + " --scene " + path("tiny.toml") + " -o ";
  const Outcome one = runInspect(plot + path("1.png") + " --threads 1 --stats " + path("s.json"));
  ASSERT_EQ(one.code, kExitOk) << one.output;
  EXPECT_EQ(Json::parse(readAll(at("s.json")))["in_sight"], 1);
  EXPECT_EQ(runInspect(plot + path("7.png") + " --threads 7").code, kExitOk);
  EXPECT_EQ(readAll(at("1.png")), readAll(at("7.png")));
  EXPECT_EQ(runInspect(plot + path("s.png") + " --size 40x30 --show-back --dot 3").code, kExitOk);
  EXPECT_NE(readAll(at("1.png")), readAll(at("s.png")));
  EXPECT_EQ(runInspect(plot + path("x.png") + " --size 0x30").code, kExitUsage);
  EXPECT_EQ(runInspect(plot + path("x.png") + " --size 40").code, kExitUsage);
  EXPECT_EQ(runInspect(plot + path("x.png") + " --color blue").code, kExitUsage);
  EXPECT_EQ(runInspect(plot + path("x.png") + " --color flux").code, kExitInput);
  EXPECT_FALSE(fs::exists(at("x.png")));
}

TEST_F(Cli, PlotRefusesAnotherScene) {
  writeTinyScene(at(""));
  writeVpl(at("rows.vpl"), tinyRows(1));
  const Outcome result = runInspect("plot " + path("rows.vpl") + " --scene " + path("tiny.toml") +
                                    " -o " + path("x.png"));
  EXPECT_EQ(result.code, kExitInput);
  EXPECT_TRUE(contains(result.output, "another scene")) << result.output;
}

}  // namespace
}  // namespace bnvpl
