// vpl-inspect doctor on scenes with one mistake each, and the warnings that name it.
#include "tools/inspect/doctor/doctor.h"

#include <nlohmann/json.hpp>

#include "tests/pipeline/tool_runner.h"
#include "tools/common/process/exit_codes.h"

namespace bnvpl {
namespace {

class Doctor : public PipelineTest {
 protected:
  // A closed room of 2 x 2 x 2 m whose walls face inwards, a camera, and a lamp at height `lampY`
  // of 0.2 x 0.2 m that faces down or up.
  void room(const std::string& name, double scale, double lampY, bool down,
            const std::string& camera = "position = [1, 1, 1.9]\nforward = [0, 0, -1]\n") const {
    write("room.mtl", "newmtl wall\nKd .5 .5 .5\nnewmtl lamp\nKd 0 0 0\nKe 10 10 10\n");
    std::string obj = "mtllib room.mtl\n";
    for (int i = 0; i < 8; ++i) obj += vertex(scale, i & 1 ? 2 : 0, i & 2 ? 2 : 0, i & 4 ? 2 : 0);
    for (int i = 0; i < 4; ++i) obj += vertex(scale, i & 1 ? 1.1 : .9, lampY, i & 2 ? 1.1 : .9);
    obj += "usemtl wall\nf 1 2 4 3\nf 5 7 8 6\nf 1 3 7 5\nf 2 6 8 4\nf 1 5 6 2\nf 3 4 8 7\n";
    obj += std::string("usemtl lamp\n") + (down ? "f 9 10 12 11\n" : "f 9 11 12 10\n");
    write("room.obj", obj);
    write(name, "[film]\nwidth = 16\nheight = 16\n[camera]\n" + camera +
                    "vertical_fov_deg = 60\n[[mesh]]\nfile = \"room.obj\"\n");
  }
  static std::string vertex(double scale, double x, double y, double z) {
    return "v " + std::to_string(scale * x) + " " + std::to_string(scale * y) + " " +
           std::to_string(scale * z) + "\n";
  }
  // What doctor finds, one text.
  std::string found(const std::string& name) const {
    const Outcome r = tool("vpl-inspect", "doctor --json " + path(name));
    EXPECT_EQ(r.code, kExitOk) << r.err;
    std::string all;
    const auto diagnosis = nlohmann::json::parse(r.out);
    for (const auto& finding : diagnosis.at("findings")) {
      EXPECT_FALSE(finding.at("change").get<std::string>().empty());
      all += finding.at("what").get<std::string>() + "\n";
    }
    return all;
  }
};

TEST_F(Doctor, FindsNothingInAGoodRoom) {
  room("good.toml", 1.0, 1.9, true);
  EXPECT_EQ(found("good.toml"), "");
  const Outcome text = tool("vpl-inspect", "doctor " + path("good.toml"));
  EXPECT_TRUE(contains(text.out, "shines towards (0, -1, 0)")) << text.out;
  EXPECT_TRUE(contains(text.out, "nothing to change")) << text.out;
  EXPECT_EQ(tool("vpl-inspect", "doctor " + path("good.toml")).out, text.out);
}

TEST_F(Doctor, WarningsOfReadingAreErrorsWithStrict) {
  room("good.toml", 1.0, 1.9, true);
  EXPECT_EQ(tool("vpl-inspect", "doctor --strict " + path("good.toml")).code, kExitOk);
  write("unused.toml",
        readAll(at("good.toml")) + "[[material]]\nname = \"nobody has it\"\nmodel = \"diffuse\"\n");
  EXPECT_EQ(tool("vpl-inspect", "doctor " + path("unused.toml")).code, kExitOk);
  EXPECT_EQ(tool("vpl-inspect", "doctor --strict " + path("unused.toml")).code, kExitInput);
}

TEST_F(Doctor, FindsALampThatFacesAWall) {
  room("wall.toml", 1.0, 1.9999, false);
  EXPECT_TRUE(contains(found("wall.toml"), "'lamp' shines into a surface right before it"))
      << found("wall.toml");
  const Outcome r =
      tool("vpl-render",
           path("wall.toml") + " --integrator path --spp 4 --quiet -o " + path("wall.exr"));
  EXPECT_EQ(r.code, kExitOk);
  EXPECT_TRUE(contains(r.err, "times darker than the power of the lights")) << r.err;
  EXPECT_TRUE(contains(r.err, "vpl-inspect doctor")) << r.err;
  // A warning about the result keeps the result.
  const std::string image = readAll(at("wall.exr"));
  fs::remove(at("wall.exr"));
  const Outcome strict =
      tool("vpl-render", path("wall.toml") + " --integrator path --spp 4 --quiet --strict -o " +
                             path("wall.exr"));
  EXPECT_EQ(strict.code, kExitInput);
  EXPECT_EQ(strict.err,
            r.err + "vpl-render: a warning is an error with --strict; the outputs are written\n");
  EXPECT_EQ(readAll(at("wall.exr")), image);
}

TEST_F(Doctor, FindsUnitsThatLookWrong) {
  room("large.toml", 150.0, 1.9, true, "position = [150, 150, 285]\nforward = [0, 0, -1]\n");
  EXPECT_TRUE(contains(found("large.toml"), "its unit may be cm or mm")) << found("large.toml");
}

TEST_F(Doctor, FindsACameraInASolidOrAwayFromTheScene) {
  room("away.toml", 1.0, 1.9, true, "position = [1, 1, 9]\nforward = [0, 0, 1]\n");
  const std::string away = found("away.toml");
  EXPECT_TRUE(contains(away, "the camera sees no surface")) << away;
  EXPECT_TRUE(contains(away, "of the light reaches what the camera sees")) << away;
  room("in.toml", 1.0, 1.9, true);
  std::string obj = readAll(at("room.obj"));
  for (const double side : {.95, 1.05}) {  // a box around the camera, wound outwards
    for (int i = 0; i < 4; ++i) obj += vertex(1.0, i & 1 ? 1.1 : .9, i & 2 ? 1.1 : .9, side + .9);
  }
  write("room.obj", obj +
                        "usemtl wall\nf 13 15 16 14\nf 17 18 20 19\nf 13 17 19 15\nf 14 16 20 18\n"
                        "f 13 14 18 17\nf 15 19 20 16\n");
  EXPECT_TRUE(contains(found("in.toml"), "it is inside a solid")) << found("in.toml");
}

TEST_F(Doctor, NamesMissingTextures) {
  room("bare.toml", 1.0, 1.9, true);
  write("room.mtl",
        "newmtl wall\nmap_Kd wood.png\nmap_Ke glow.png\nnewmtl lamp\nKd 0 0 0\nKe 10 10 10\n");
  const std::string all = found("bare.toml");
  EXPECT_TRUE(contains(all, "textures or other files are missing: ")) << all;
  EXPECT_TRUE(contains(all, at("wood.png").string()) && contains(all, at("glow.png").string()))
      << all;
  EXPECT_EQ(std::ranges::count(all, '\n'), 1) << all;  // the warnings themselves are left out
}

// A hall beside the closed room has 100 times its surface, but light from there never arrives.
TEST_F(Doctor, CountsVplsOnlyWhereTheyLightTheView) {
  room("hall.toml", 1.0, 1.9, true);
  std::string obj = readAll(at("room.obj")) + "usemtl wall\n";
  for (int i = 0; i < 8; ++i) obj += vertex(1.0, i & 1 ? 30 : 10, i & 2 ? 30 : 10, i & 4 ? 30 : 10);
  obj +=
      "f 13 14 16 15\nf 17 19 20 18\nf 13 15 19 17\nf 14 18 20 16\nf 13 17 18 14\nf 15 16 20 19\n";
  write("room.obj", obj);
  EXPECT_EQ(found("hall.toml"), "");
  const auto vpls =
      nlohmann::json::parse(tool("vpl-inspect", "doctor --json " + path("hall.toml")).out)["vpls"];
  EXPECT_GT(vpls.at("surface"), 2400.0);
  EXPECT_NEAR(vpls.at("in_use").get<double>() * vpls.at("surface").get<double>(), 24.0, 8.0);
}

TEST_F(Doctor, KnowsTheRatesOfTheCostModelAndTheCountsOfThePipeline) {
  const auto rates =
      nlohmann::json::parse(readAll(BNVPL_SOURCE "/pipelines/cost_model.json")).at("rates");
  EXPECT_EQ(rates.at("estimate").at("cpu_s").at("photons"), kSecondsPerPhoton);
  const auto render = rates.at("render").at("cpu_s");
  EXPECT_EQ(render.at("samples log2(VPLs)"), kSecondsPerSampleLog2Vpls);
  EXPECT_EQ(render.at("samples"), kSecondsPerSample);
  EXPECT_EQ(render.at("samples log2(triangles)"), kSecondsPerSampleLog2Triangles);
  const std::string presets = readAll(BNVPL_SOURCE "/pipelines/quality.mk");
  EXPECT_TRUE(contains(presets, "VPLS.default       := 3k"));
  EXPECT_EQ(kUsualVpls, 3000.0);
}

}  // namespace
}  // namespace bnvpl
