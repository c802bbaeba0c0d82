// Scene files written by other programs, and messages about those that lack something.
#include <algorithm>

#include "formats/image/exr_io.h"
#include "formats/vpl/vpl_io.h"
#include "tests/pipeline/tool_runner.h"
#include "tools/common/process/exit_codes.h"

namespace bnvpl {
namespace {

class SceneFilesOfOthers : public PipelineTest {
 protected:
  // Copies Blender's room into the test's folder and adds a scene.toml.
  void SetUp() override {
    fs::copy(BNVPL_SOURCE "/tests/scene/blender", at("von Blender"), fs::copy_options::recursive);
    write("von Blender/my room.toml",
          "[film]\nwidth = 32\nheight = 24\n[camera]\nposition = [0, 1, 4]\nlook_at = [0, 1, 0]\n"
          "vertical_fov_deg = 50\n[[mesh]]\nfile = \"my room.obj\"\n");
  }
  const std::string room_ = path("von Blender/my room.toml");

  void replaceAll(const std::string& name, const std::string& from, const std::string& to) const {
    std::string text = readAll(at(name));
    size_t count = 0;
    for (size_t i = 0; (i = text.find(from, i)) != std::string::npos; i += to.size(), ++count)
      text.replace(i, from.size(), to);
    EXPECT_GT(count, 0u) << from;
    write(name, text);
  }
  // Returns the messages of vpl-place and the colours that it finds.
  std::string place(std::vector<Vec3>& colours) const {
    const Outcome r = tool("vpl-place", room_ + " --quiet -n 300 -o " + path("c.vpl"));
    EXPECT_EQ(r.code, kExitOk) << r.err;
    colours = readVpl(at("c.vpl")).albedo;
    return r.err;
  }
  static size_t count(const std::vector<Vec3>& colours, Vec3 colour) {
    return size_t(std::count(colours.begin(), colours.end(), colour));
  }
  // The room has red and green walls, and a floor with a blue texture.
  static void expectRoom(const std::vector<Vec3>& colours) {
    EXPECT_GT(count(colours, {.8f, .1f, .1f}), 0u);
    EXPECT_GT(count(colours, {.1f, .8f, .1f}), 0u);
    EXPECT_GT(std::count_if(colours.begin(), colours.end(),
                            [](Vec3 c) { return c.x == 0 && c.y == 0 && c.z > .5f; }),
              0);
  }
};

TEST_F(SceneFilesOfOthers, BlendersNamesAreFound) {
  std::vector<Vec3> colours;
  EXPECT_EQ(place(colours), "");
  expectRoom(colours);
}

// Blender writes underscores for spaces; other programs do not. Windows adds a byte order mark.
TEST_F(SceneFilesOfOthers, BlanksMarksAndContinuedLinesAreRead) {
  for (const std::string name : {"von Blender/my room.obj", "von Blender/my room.mtl"}) {
    replaceAll(name, "my_left", "my left");
    replaceAll(name, "my.right_2", "my.right  2");
    replaceAll(name, "Lampe__weiß.001", "Lampe  weiß.001");
    replaceAll(name, "\n", "\r\n");
    write(name, "\xef\xbb\xbf" + readAll(at(name)));
  }
  std::string mtl = readAll(at("von Blender/my room.mtl"));
  write("von Blender/my room.mtl", "\xef\xbb\xbf" + mtl.substr(mtl.find("newmtl")));
  replaceAll("von Blender/my room.obj", "f 5/5/2 6/6/2", "f 5/5/2 \\\r\n 6/6/2");
  std::vector<Vec3> colours;
  EXPECT_EQ(place(colours), "");
  expectRoom(colours);
}

TEST_F(SceneFilesOfOthers, MissingMaterialsAreNamed) {
  replaceAll("von Blender/my room.mtl", "my_left", "my_right");
  std::vector<Vec3> colours;
  const std::string said = place(colours);
  EXPECT_TRUE(contains(said, "my room.obj: has faces without a known material")) << said;
  EXPECT_TRUE(contains(said, "'my_left' is not in ")) << said;
  EXPECT_TRUE(contains(said, "my room.mtl\n")) << said;
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
  EXPECT_GT(count(colours, Vec3(.5f)), 0u);
}

// Stages that need light refuse the scene; the others explain why the image will be black.
TEST_F(SceneFilesOfOthers, ASceneWithoutLightSaysSo) {
  replaceAll("von Blender/my room.mtl", "Ke 10.000000 10.000000 10.000000", "Ke 0 0 0");
  const std::string problem = "my room.toml: has no light with power", cure = "add a [[light]]";
  for (const auto& [name, arguments] :
       {std::pair{"vpl-place", " -n 30 -o " + path("c.vpl")},
        std::pair{"vpl-render", " --integrator path --spp 1 -o " + path("i.exr")}}) {
    const Outcome r = tool(name, room_ + arguments);
    EXPECT_EQ(r.code, kExitOk) << r.err;
    EXPECT_TRUE(contains(r.err, problem) && contains(r.err, cure) && contains(r.err, "Ke"))
        << name << ": " << r.err;
    EXPECT_EQ(contains(r.err, "the image is black"), name == std::string("vpl-render"));
  }
  succeed("vpl-eliminate", path("c.vpl") + " -n 5 -o " + path("v.vpl"));
  fail("vpl-place", room_ + " --method light -n 30 -o " + path("l.vpl"), kExitInput,
       {problem, cure});
  fail("vpl-estimate", room_ + " " + path("v.vpl") + " --photons 100 -o " + path("l.vpl"),
       kExitInput, {problem, cure});
  EXPECT_FALSE(fs::exists(at("l.vpl")));
}

// A tool that also reads files made from the scene leaves its warnings to the tool that made them.
TEST_F(SceneFilesOfOthers, WarningsArePrintedOnceForAllTools) {
  replaceAll("von Blender/my room.mtl", "my_left", "my_right");
  const auto warns = [&](const std::string& name, const std::string& arguments) {
    const Outcome r = tool(name, arguments);
    EXPECT_EQ(r.code, kExitOk) << r.err;
    return contains(r.err, "without a known material");
  };
  const std::string by = " --scene " + room_;
  EXPECT_TRUE(warns("vpl-place", room_ + " -n 300 -o " + path("c.vpl")));
  EXPECT_FALSE(warns("vpl-eliminate", path("c.vpl") + " -n 30 -o " + path("v.vpl")));
  EXPECT_FALSE(
      warns("vpl-estimate", room_ + " " + path("v.vpl") + " --photons 1k -o " + path("l.vpl")));
  EXPECT_FALSE(warns("vpl-render", room_ + " " + path("l.vpl") + " --spp 1 -o " + path("i.exr")));
  EXPECT_FALSE(warns("vpl-inspect", "check " + path("c.vpl") + " " + path("i.exr") + by));
  EXPECT_FALSE(warns("vpl-inspect", "plot " + path("l.vpl") + by + " -o " + path("p.png")));
  EXPECT_TRUE(warns("vpl-render", room_ + " --integrator path --spp 1 -o " + path("p.exr")));
}

TEST_F(SceneFilesOfOthers, FoldersAreRefusedAsSuch) {
  fs::create_directories(at("dir.toml"));
  for (const char* name : {"dir.toml", "von Blender"})
    fail("vpl-place", path(name) + " -n 3 -o " + path("x"), kExitInput, {name, ": is a folder"});
}

TEST_F(SceneFilesOfOthers, OtherFormatsAreRefusedByName) {
  fail("vpl-place", path("von Blender/my room.mtl") + " -n 3 -o " + path("x"), kExitInput,
       {"my room.mtl", "is no scene file; scenes are read from .toml"});
}

// An OBJ is a scene. Without a camera one is placed; without light the cure is a command.
TEST_F(SceneFilesOfOthers, AnObjIsASceneOfItsOwn) {
  const std::string obj = path("von Blender/my room.obj"), rest = " -n 30 -o " + path("c.vpl");
  const Outcome ok = tool("vpl-place", obj + rest);
  EXPECT_EQ(ok.code, kExitOk) << ok.err;
  EXPECT_TRUE(contains(ok.err, "has no camera; one is placed that sees the whole scene")) << ok.err;
  replaceAll("von Blender/my room.mtl", "Ke 10.000000 10.000000 10.000000", "Ke 0 0 0");
  const std::string image = " --integrator path --spp 1 -o " + path("i.exr");
  for (const auto& [name, arguments] : {std::pair{"vpl-render", image}, {"vpl-place", rest}}) {
    const Outcome dark = tool(name, obj + arguments);
    EXPECT_EQ(dark.code, kExitInput);
    EXPECT_EQ(std::count(dark.err.begin(), dark.err.end(), '\n'), 2) << dark.err;
  }
  const Outcome dark = tool("vpl-place", obj + rest);
  const size_t cure = dark.err.find("printf");
  ASSERT_NE(cure, std::string::npos) << dark.err;
  ASSERT_EQ(std::system(dark.err.substr(cure).c_str()), 0);
  succeed("vpl-render", path("von Blender/my room-lit.toml") + image);
}

// The image depends on the filter, the VPLs do not.
TEST_F(SceneFilesOfOthers, TheFilterOfTheFilmIsThatOfTheImage) {
  std::string film = readAll(at("von Blender/my room.toml"));
  film.insert(film.find("width"), "filter = \"gaussian\"\nfilter_radius = 2\n");
  write("von Blender/soft.toml", film);
  makeStages(room_);
  const std::string soft = path("von Blender/soft.toml") + " " + path("lit.vpl"),
                    plain = room_ + " " + path("lit.vpl");
  const auto render = [&](const std::string& arguments, const std::string& name) {
    succeed("vpl-render", arguments + " --spp 2 --quiet -o " + path(name));
    return readExr(at(name));
  };
  const Image whole = render(soft, "soft.exr"), box = render(soft + " --filter box", "box.exr");
  const Image asked = render(plain + " --filter gaussian --filter-radius 2", "asked.exr");
  EXPECT_EQ(*whole.find("R"), *asked.find("R"));
  EXPECT_EQ(*box.find("R"), *render(plain, "plain.exr").find("R"));
  EXPECT_NE(*whole.find("R"), *box.find("R"));
  EXPECT_EQ(*render(soft + " --filter-radius 1.25", "narrow.exr").find("R"),
            *render(plain + " --filter gaussian --filter-radius 1.25", "asked2.exr").find("R"));
  EXPECT_EQ(*render(soft + " --filter mitchell", "mitchell.exr").find("R"),
            *render(plain + " --filter mitchell", "asked3.exr").find("R"));
  for (const Image* image : {&whole, &asked})
    EXPECT_TRUE(contains(image->attributes.at("bnvpl.provenance"), "\"filter\":\"gaussian\""));
  for (const char* part : {"1", "2"})
    succeed("vpl-render", soft + " --spp 2 --quiet --shard " + part + "/2 -o " +
                              path(std::string(part) + ".shard"));
  succeed("vpl-merge",
          path("1.shard") + " " + path("2.shard") + " --quiet -o " + path("merged.exr"));
  EXPECT_EQ(readAll(at("merged.exr")), readAll(at("soft.exr")));
  succeed("vpl-inspect", "check --quiet " + path("soft.exr") + " " + path("lit.vpl"));
}

TEST_F(SceneFilesOfOthers, TheFieldOfViewTakesItsLimits) {
  const std::string whole = readAll(at("von Blender/my room.toml"));
  for (const std::string degrees : {"0.001", "179.9"}) {
    write("von Blender/my room.toml", whole);
    replaceAll("von Blender/my room.toml", "vertical_fov_deg = 50",
               "vertical_fov_deg = " + degrees);
    succeed("vpl-render", room_ + " --integrator path --spp 1 -o " + path("i.exr"));
  }
  write("von Blender/my room.toml", whole);
  replaceAll("von Blender/my room.toml", "vertical_fov_deg = 50", "vertical_fov_deg = 179.91");
  fail("vpl-render", room_ + " --integrator path --spp 1 -o " + path("x.exr"), kExitInput,
       {"my room.toml:7: [camera]: 'vertical_fov_deg' is 179.91, outside 0.001 to 179.9"});
}

// The scene does without the definition of its shards; vpl-merge has no option to leave out.
using ChangedScene = PipelineTest;
TEST_F(ChangedScene, IsNamedByTheMergeOfItsShards) {
  fs::copy(BNVPL_SOURCE "/scenes/cornell", at("room"), fs::copy_options::recursive);
  write("scene.toml", "[[mesh]]\nfile = \"${ROOM}/scene.toml\"\n");
  const std::string scene = path("scene.toml"), defined = scene + " --define ROOM=room --quiet ";
  succeed("vpl-place", defined + "-n 2k -o " + path("c.vpl"));
  succeed("vpl-eliminate", path("c.vpl") + " -n 20 --quiet -o " + path("v.vpl"));
  succeed("vpl-estimate",
          defined + path("v.vpl") + " --photons 2k --shard 1/1 -o " + path("l.shard"));
  write("scene.toml", "[[mesh]]\nfile = \"room/scene.toml\"\n");
  fail("vpl-merge", path("l.shard") + " -o " + path("x.vpl"), kExitInput,
       {"scene.toml: has changed since the shards were made", "make them again"});
}

}  // namespace
}  // namespace bnvpl
