// vpl-inspect scene: its report, and the scene that it writes, which equals the original.
#include "scene/choose_view.h"
#include "scene/load_scene.h"
#include "tests/inspect/run_inspect.h"
#include "tests/inspect/tiny_scene.h"
#include "tools/inspect/scene/scene_difference.h"

namespace bnvpl {
namespace {

using SceneReport = InspectTest;

std::string quoted(const fs::path& path) { return "'" + path.string() + "'"; }

TEST_F(SceneReport, NamesWhatTheSceneHolds) {
  writeTinyScene(at("."));
  const Outcome text = runInspect("scene " + quoted(at("tiny.toml")));
  EXPECT_EQ(text.code, 0) << text.output;
  for (const char* part :
       {"triangles: 4 ", "tiny.obj: 4 triangles", "'white': phong", "point light", "film 80x60"})
    EXPECT_NE(text.output.find(part), std::string::npos) << part << " in\n" << text.output;

  const Json json = Json::parse(runInspect("scene --json " + quoted(at("tiny.toml"))).output);
  EXPECT_EQ(json["materials"].size(), 1u);
  EXPECT_NEAR(json["lights"][0]["power_W"][0].get<double>(), 4.0 * 3.14159265, 1e-4);
  EXPECT_EQ(json["cameras"][0]["position"][2].get<double>(), 4.0);
  EXPECT_EQ(json["warnings"].size(), 0u);
}

TEST_F(SceneReport, WhatItWritesIsTheSceneAgain) {
  writeTinyScene(at("."));
  const Outcome written =
      runInspect("scene --to-toml " + quoted(at("copy")) + " " + quoted(at("tiny.toml")));
  ASSERT_EQ(written.code, 0) << written.output;
  const Scene before = loadScene(at("tiny.toml")), after = loadScene(at("copy/scene.toml"));
  EXPECT_EQ(after.contentHash, before.contentHash);
  EXPECT_EQ(after.camera.position, before.camera.position);
  EXPECT_LT(length(after.camera.forward - before.camera.forward), 1e-6f);
  EXPECT_NEAR(after.camera.verticalFovRad, before.camera.verticalFovRad, 1e-6f);
  EXPECT_EQ(after.film.width, before.film.width);
}

TEST_F(SceneReport, ItsOwnFilesAreNotOverwritten) {
  writeTinyScene(at("."));
  fs::rename(at("tiny.toml"), at("scene.toml"));
  const Outcome refused =
      runInspect("scene --to-toml " + quoted(at(".")) + " " + quoted(at("scene.toml")));
  EXPECT_EQ(refused.code, 2) << refused.output;
}

TEST_F(SceneReport, AViewFileReplacesTheCamera) {
  writeTinyScene(at("."));
  writeAll(at("view.toml"),
           "[film]\nwidth = 20\nheight = 10\n[camera]\nposition = [0, 1, 2]\nlook_at = [0, 0, 0]\n"
           "vertical_fov_deg = 30\n");
  const Outcome ok = runInspect("scene --view " + quoted(at("view.toml")) + " --to-toml " +
                                quoted(at("copy")) + " " + quoted(at("tiny.toml")));
  ASSERT_EQ(ok.code, 0) << ok.output;
  EXPECT_EQ(loadScene(at("copy/scene.toml")).film.width, 20u);
  EXPECT_EQ(runInspect("scene --camera 3 " + quoted(at("tiny.toml"))).code, 2);
}

TEST_F(SceneReport, TellsAndWritesTheLens) {
  writeTinyScene(at("."));
  const std::string lens = "lens_radius = 0.1\nfocus_distance = 2.3\n";
  std::string toml = readAll(at("tiny.toml"));
  writeAll(at("tiny.toml"), toml.insert(toml.find("vertical_fov_deg"), lens));
  const Outcome ok =
      runInspect("scene --to-toml " + quoted(at("copy")) + " " + quoted(at("tiny.toml")));
  EXPECT_NE(ok.output.find("lens_radius 0.1"), std::string::npos) << ok.output;
  EXPECT_NE(ok.output.find("focus_distance 2.3"), std::string::npos) << ok.output;
  Scene scene = loadScene(at("tiny.toml"));
  const Scene copy = loadScene(at("copy/scene.toml"));
  EXPECT_EQ(copy.camera.lensRadius, 0.1f);
  EXPECT_EQ(copy.camera.focusDistance, 2.3f);
  EXPECT_EQ(sceneDifference(scene, copy), "");
  writeAll(at("view.toml"),
           "[film]\nwidth = 80\nheight = 60\n[camera]\nposition = [0, 1, 4]\nlook_at = [0, 1, 0]\n"
           "vertical_fov_deg = 50\nlens_radius = 0.5\nfocus_distance = 1\n");
  useViewFile(at("view.toml"), scene);
  EXPECT_EQ(scene.camera.lensRadius, 0.5f);
  EXPECT_EQ(sceneDifference(scene, copy), "camera or film");
}

TEST_F(SceneReport, TellsAndWritesThePixelFilter) {
  writeTinyScene(at("."));
  std::string toml = readAll(at("tiny.toml"));
  writeAll(at("tiny.toml"),
           toml.insert(toml.find("width"), "filter = \"gaussian\"\nfilter_radius = 1.7\n"));
  const Outcome ok =
      runInspect("scene --to-toml " + quoted(at("copy")) + " " + quoted(at("tiny.toml")));
  EXPECT_NE(ok.output.find("filter gaussian, filter_radius 1.7"), std::string::npos) << ok.output;
  Scene scene = loadScene(at("tiny.toml"));
  const Scene copy = loadScene(at("copy/scene.toml"));
  EXPECT_EQ(copy.film.filter, (FilterSpec{FilterKind::Gaussian, 1.7f}));
  EXPECT_EQ(sceneDifference(scene, copy), "");
  scene.film.filter.kind = FilterKind::Mitchell;
  EXPECT_EQ(sceneDifference(scene, copy), "camera or film");
}

// A name may hold any bytes except those that end it.
TEST_F(SceneReport, NamesThatAreNoUtf8OrHoldLineBreaksAreNames) {
  writeTinyScene(at("."));
  std::string obj = readAll(at("tiny.obj"));
  obj.replace(obj.find("usemtl white"), 12, "usemtl w\xff\x1b[1m");
  writeAll(at("tiny.obj"), obj);
  writeAll(at("tiny.mtl"), "newmtl w\xff\x1b[1m\nKd 0.7 0.7 0.7\n");
  fs::rename(at("tiny.toml"), at("tiny\xfe\n0.toml"));
  const std::string scene = quoted(at("tiny\xfe\n0.toml"));

  const Outcome json = runInspect("scene --json " + scene);
  EXPECT_EQ(json.code, 0) << json.output;
  const Json read = Json::parse(json.output);
  EXPECT_EQ(read["materials"][0]["name"], "w\uFFFD\x1b[1m");
  EXPECT_TRUE(read["scene"].get<std::string>().ends_with("tiny\uFFFD\n0.toml"));
  EXPECT_EQ(runInspect("scene --stats " + quoted(at("s.json")) + " " + scene).code, 0);
  EXPECT_EQ(Json::parse(readAll(at("s.json")))["scene"]["materials"][0]["name"], "w\uFFFD\x1b[1m");

  const Outcome text = runInspect("scene " + scene);
  EXPECT_TRUE(contains(text.output, "tiny\\xfe\\n0.toml, content ")) << text.output;
  EXPECT_TRUE(contains(text.output, "\n  'w\\xff\\x1b[1m': phong")) << text.output;
  EXPECT_EQ(runInspect("scene --to-toml " + quoted(at("copy")) + " " + scene).code, 0);
}

TEST_F(SceneReport, ListsObjectsAndWritesTheirNames) {
  writeTinyScene(at("."));
  std::string obj = readAll(at("tiny.obj"));
  obj.insert(obj.find("f 5 6 7 8"), "o my \"floor\"\n");
  writeAll(at("tiny.obj"), obj);
  writeAll(
      at("all.toml"),
      readAll(at("tiny.toml")) + "[[mesh]]\nfile = \"tiny.obj\"\n[[mesh.instance]]\n" +
          "translate = [0, 5, 0]\nname = \"copy\"\n[[mesh.instance]]\ntranslate = [0, 9, 0]\n" +
          "[[light]]\nname = \"key\"\ntype = \"rectangle\"\nposition = [0, 20, 0]\n" +
          "direction = [0, -1, 0]\nwidth = 1\nheight = 1\npower = [5, 5, 5]\n" +
          "[[light]]\nname = \"bulb\"\ntype = \"point\"\nposition = [0, 20, 0]\n" +
          "power = [5, 5, 5]\n");
  const auto report = [&](const std::string& scene) {
    const Outcome r = runInspect("scene --json " + quoted(at(scene)));
    EXPECT_EQ(r.code, 0) << r.output;
    return Json::parse(r.output);
  };
  const Json json = report("all.toml");
  ASSERT_EQ(json["objects"].size(), 4u) << json["objects"];
  std::map<std::string, std::pair<int, int>> objects;
  for (const Json& o : json["objects"])
    objects[o["name"]] = {o["triangles"].get<int>(), o["instances"].get<int>()};
  EXPECT_EQ(objects.at("tiny"), std::pair(4, 1));  // two of the mesh, two of its instance
  EXPECT_EQ(objects.at("my \"floor\""), std::pair(4, 1));
  EXPECT_EQ(objects.at("copy"), std::pair(4, 1));
  EXPECT_EQ(objects.at("key"), std::pair(2, 0));
  EXPECT_EQ(json["lights"].back()["light"], "point light 'bulb'");
  const Outcome text = runInspect("scene " + quoted(at("all.toml")));
  EXPECT_TRUE(contains(text.output, "'copy': 4 triangles in 1 instances")) << text.output;
  EXPECT_TRUE(contains(text.output, "emissive material 'key': (5 5 5) W")) << text.output;
  EXPECT_TRUE(contains(text.output, "  0 (no name): position")) << text.output;

  ASSERT_EQ(runInspect("scene --to-toml " + quoted(at("copy")) + " " + quoted(at("all.toml"))).code,
            0);
  const Json again = report("copy/scene.toml");
  EXPECT_EQ(again["objects"], json["objects"]);
  EXPECT_EQ(again["lights"].back()["light"], "point light 'bulb'");
}

TEST_F(SceneReport, TellsAndWritesLightGroups) {
  writeTinyScene(at("."));
  EXPECT_FALSE(contains(runInspect("scene " + quoted(at("tiny.toml"))).output, "group"));
  writeAll(at("tiny.mtl"), "newmtl white\nKd 0.7 0.7 0.7\nKe 1 1 1\n");
  writeAll(at("all.toml"), readAll(at("tiny.toml")) + "group = \"rim\"\n[[light]]\n" +
                               "type = \"material\"\nmaterial = \"white\"\ngroup = \"key\"\n" +
                               "[[light]]\ntype = \"disk\"\nradius = 1\nposition = [0, 9, 0]\n" +
                               "direction = [0, 1, 0]\npower = [5, 5, 5]\n");
  const Outcome text = runInspect("scene " + quoted(at("all.toml")));
  for (const char* part : {"material 'white': (115.9 115.9 115.9) W, group key", "group default",
                           "point light: (12.57 12.57 12.57) W, group rim"})
    EXPECT_TRUE(contains(text.output, part)) << part << " in\n" << text.output;
  ASSERT_EQ(runInspect("scene --to-toml " + quoted(at("copy")) + " " + quoted(at("all.toml"))).code,
            0);
  const Scene before = loadScene(at("all.toml")), after = loadScene(at("copy/scene.toml"));
  EXPECT_EQ(after.lightGroups, (std::vector<std::string>{"default", "key", "rim"}));
  EXPECT_EQ(sceneDifference(before, after), "");
}

// Triangles of instances count too, although each mesh is stored once.
TEST_F(SceneReport, CountsMaskedTriangles) {
  writeTinyScene(at("."));
  writeAll(at("tiny.mtl"), "newmtl white\nKd 0.7 0.7 0.7\nnewmtl gone\nKd 1 1 1\nd 0.2\n");
  std::string obj = readAll(at("tiny.obj"));
  obj.insert(obj.find("f 5 6 7 8"), "usemtl gone\n");
  writeAll(at("tiny.obj"), obj);
  const auto count = [&] {
    return Json::parse(runInspect("scene --json " + quoted(at("tiny.toml"))).output)
        .at("masked_triangles");
  };
  EXPECT_EQ(count(), 2);
  std::string toml = readAll(at("tiny.toml"));
  toml.insert(
      toml.find("[[light]]"),
      "[[mesh.instance]]\ntranslate = [0, 0, 0]\n[[mesh.instance]]\ntranslate = [0, 9, 0]\n");
  writeAll(at("tiny.toml"), toml);
  EXPECT_EQ(count(), 2);
  EXPECT_EQ(loadScene(at("tiny.toml")).prototypes.size(), 1u);
}

}  // namespace
}  // namespace bnvpl
