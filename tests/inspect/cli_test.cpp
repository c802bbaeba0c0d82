// The executable itself: its exit codes, files and printed output.
#include "scene/load_scene.h"
#include "tests/inspect/run_inspect.h"
#include "tests/inspect/tiny_scene.h"
#include "tools/common/process/exit_codes.h"

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
  writeAll(at("room.toml"), "[film]\n");
  const Outcome scene = runInspect("info " + path("room.toml"));
  EXPECT_TRUE(contains(scene.output, "or run vpl-inspect scene on a scene")) << scene.output;
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

TEST_F(Cli, ListsContributionsWithTheSameBytesForAnyThreadCount) {
  writeTinyScene(at(""));
  const Scene scene = loadScene(at("tiny.toml"));
  VplTable lit = tinyRows(scene.contentHash);
  writeVpl(at("rows.vpl"), lit);
  lit.stage = VplStage::Lit;
  lit.position[0] = {-0.5f, 0.25f, 2};
  lit.normal[0] = {0, 0, -1};
  lit.radius.assign(4, 0.1f);
  lit.flux.assign(4, Vec3(1.0f));
  lit.photons.assign(4, 1);
  lit.relativeError.assign(4, 0.1f);
  lit.emitPosition = lit.position;
  lit.emitNormal = lit.normal;
  lit.firstBounceFlux.assign(4, Vec3(0.0f));
  writeVpl(at("lit.vpl"), lit);
  const std::string scenePart = " --scene " + path("tiny.toml") + " -o ";
  const std::string list = "contributions " + path("lit.vpl") + scenePart;
  const Outcome one = runInspect(list + path("1.json") + " --threads 1 --depfile " + path("1.d"));
  ASSERT_EQ(one.code, kExitOk) << one.output;
  EXPECT_EQ(runInspect(list + path("7.json") + " --threads 7").code, kExitOk);
  EXPECT_EQ(readAll(at("1.json")), readAll(at("7.json")));
  EXPECT_TRUE(contains(readAll(at("1.d")), "tiny.mtl"));
  const Json found = Json::parse(readAll(at("1.json")));
  EXPECT_EQ(found.at("format"), "bnvpl.contributions");
  EXPECT_EQ(found.at("width"), 80);
  EXPECT_EQ(found.at("pixels").at("rows").size(), 80u * 60u);
  EXPECT_TRUE(found.at("rows").at("x")[3].is_null()) << "it is behind the camera";
  EXPECT_GT(found.at("rows").at("radiance")[0].get<double>(), 0.0);

  // An existing list may be replaced, other JSON not.
  EXPECT_EQ(runInspect(list + path("1.json") + " --per-pixel 1 --size 8x6").code, kExitOk);
  writeAll(at("package.json"), "{\"name\": \"x\"}");
  EXPECT_NE(runInspect(list + path("package.json")).code, kExitOk);
  EXPECT_EQ(readAll(at("package.json")), "{\"name\": \"x\"}");
  for (const std::string& command :
       {"contributions " + path("rows.vpl") + scenePart + path("x.json"),
        "plot " + path("rows.vpl") + scenePart + path("x.png") + " --color contribution"}) {
    const Outcome unlit = runInspect(command);
    EXPECT_EQ(unlit.code, kExitInput);
    EXPECT_TRUE(contains(unlit.output, "vpl-estimate")) << unlit.output;
  }
  // A VPL that lights nothing has the colour of the least.
  const std::string plot = "plot " + path("lit.vpl") + scenePart;
  EXPECT_EQ(runInspect(plot + path("c.png") + " --color contribution --show-back").code, kExitOk);
  EXPECT_EQ(runInspect(plot + path("f.png") + " --show-back").code, kExitOk);
  EXPECT_NE(readAll(at("c.png")), readAll(at("f.png")));
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
