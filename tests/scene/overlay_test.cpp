// A scene.toml over files of other formats: their places, cameras, lights and materials.
#include "scene/builder/scene_builder.h"
#include "scene/choose_view.h"
#include "tests/scene/gltf/gltf_files.h"

namespace bnvpl {
namespace {

const std::string kPbrtSquare =
    "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3]\n"
    "  \"point3 P\" [-1 -1 0  1 -1 0  1 1 0  -1 1 0] \"point2 uv\" [0 0 1 0 1 1 0 1]\n";

class Overlay : public SceneFiles {
 protected:
  void SetUp() override {
    Gltf g = cornerGltf();
    g.add("materials", "{\"name\":\"paint\"}");
    g.addMesh("{\"attributes\":{\"POSITION\":0},\"material\":0}");
    g.add("cameras", "{\"type\":\"perspective\",\"perspective\":{\"yfov\":0.8,\"znear\":0.1}}");
    g.more =
        ",\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"point\","
        "\"intensity\":683}]}}";
    g.show("{\"name\":\"Wall\",\"mesh\":0}");
    g.show("{\"name\":\"Door\",\"camera\":0,\"translation\":[0,0,5]}");
    g.show(
        "{\"name\":\"Lamp\",\"translation\":[0,1,0],"
        "\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}}");
    write("sub/room.glb", g.glb());
    write("sub/room.pbrt",
          "LookAt 0 0 -5  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 40\n"
          "Film \"rgb\" \"integer xresolution\" 20 \"integer yresolution\" 10\nWorldBegin\n"
          "LightSource \"distant\" \"point3 from\" [0 1 0] \"point3 to\" [0 0 0]\n"
          "MakeNamedMaterial \"paint\" \"string type\" \"diffuse\"\nNamedMaterial \"paint\"\n" +
              kPbrtSquare);
    write("sub/square.obj", kSquareObj);
    write("sub/bent.obj",
          "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nvn -0 0 -1\nvn 0.6 -0 -0.8\nvn -0.6 -0.8 -0\n"
          "f 1//1 2//2 3//3\n");
    write("sub/square.mtl", "newmtl paint\nKd 1 1 1\nmap_Kd dot.tga\n");
    write("sub/dot.tga", tga(1, 1, {{10, 20, 30, 255}}));
  }
  static std::string mesh(const std::string& name, const std::string& more = "") {
    return "[[mesh]]\nfile = \"sub/" + name + "\"\n" + more;
  }
  Scene loadFile(const std::string& name) const { return loadScene(at(name)); }
};

TEST_F(Overlay, FilesOfAllFormatsLieBesideEachOther) {
  const Scene s = load(kFilmAndCamera + mesh("room.glb", "translate = [10, 0, 0]\n") +
                       mesh("room.pbrt", "scale = 3\n") + mesh("square.obj"));
  EXPECT_EQ(s.triangles.size(), 5u);
  EXPECT_EQ(s.bounds.lower, Vec3(-3, -3, 0));
  EXPECT_EQ(s.bounds.upper, Vec3(11, 3, 0));
  EXPECT_EQ(s.objectNames, (std::vector<std::string>{"room.pbrt:7", "square", "Wall"}));
  EXPECT_EQ(s.textures.size(), 1u) << "relative to the included file";
  std::set<fs::path> files(s.files.begin(), s.files.end());
  for (const char* name : {"scene.toml", "sub/room.glb", "sub/room.pbrt", "sub/square.obj",
                           "sub/square.mtl", "sub/dot.tga"})
    EXPECT_TRUE(files.contains(at(name))) << name;
}

TEST_F(Overlay, AFileThatIsIncludedIsTheSameScene) {
  for (const char* name : {"room.glb", "room.pbrt", "square.obj", "bent.obj"}) {
    const Scene alone = loadFile(std::string("sub/") + name), over = load(mesh(name));
    EXPECT_EQ(over.contentHash, alone.contentHash) << name;
    EXPECT_EQ(over.film.width, alone.film.width) << name;
    EXPECT_EQ(over.camera.position, alone.camera.position) << name;
    EXPECT_EQ(over.camera.isMirrored(), alone.camera.isMirrored()) << name;
    EXPECT_EQ(over.views.size(), alone.views.size()) << name;
    EXPECT_NE(load(mesh(name, "translate = [0, 1, 0]\n")).contentHash, alone.contentHash) << name;
  }
}

TEST_F(Overlay, ItsFilmAndCameraComeFirst) {
  const Scene both = load(kFilmAndCamera + mesh("room.glb") + mesh("room.pbrt"));
  EXPECT_EQ(both.views.size(), 1u);
  EXPECT_EQ(both.film.width, 8u);
  EXPECT_FALSE(std::ranges::equal(cameraList(both), std::string("Door")));
  const Scene film = load("[film]\nwidth = 8\nheight = 6\n" + mesh("room.glb"));
  EXPECT_EQ(film.views.at(0).name, "Door");
  EXPECT_EQ(film.film.width, 8u);
  const std::string camera = kFilmAndCamera.substr(kFilmAndCamera.find("[camera]"));
  const Scene pbrt = load(camera + mesh("room.pbrt"));
  EXPECT_EQ(pbrt.film.width, 20u) << "that of the file";
  EXPECT_TRUE(pbrt.camera.isMirrored()) << "as the camera that it replaces";
  EXPECT_FALSE(load(camera + "mirrored = false\n" + mesh("room.pbrt")).camera.isMirrored());
  write("sub/film.toml", "[film]\nwidth = 20\nheight = 10\n[[mesh]]\nfile = \"square.obj\"\n");
  EXPECT_EQ(load(camera + mesh("film.toml")).film.width, 20u) << "that of a file without camera";
  EXPECT_EQ(load(kFilmAndCamera + mesh("film.toml")).film.width, 8u);
  EXPECT_EQ(load(mesh("film.toml")).film.width, 20u) << "for the view of the whole";
  const Scene two = load(mesh("room.glb") + mesh("room.pbrt"));
  ASSERT_EQ(two.views.size(), 2u);
  EXPECT_EQ(two.film.width, 960u);
  EXPECT_EQ(two.views[1].film.width, 20u);
}

TEST_F(Overlay, ASkyShinesOnceFromSeveralPlaces) {
  write("sub/house.toml",
        "[[mesh]]\nfile = \"square.obj\"\n[[light]]\ntype = \"environment\"\nradiance = [1, 1, 1]\n"
        "[[light]]\ntype = \"point\"\nposition = [0, 0, 1]\npower = [1, 1, 1]\n");
  const Scene s = load(kFilmAndCamera + mesh("house.toml") +
                       "[[mesh.instance]]\n[[mesh.instance]]\ntranslate = [3, 0, 0]\n");
  EXPECT_EQ(std::ranges::count(s.lights, LightType::Environment, &LightSpec::type), 1);
  EXPECT_EQ(std::ranges::count(s.lights, LightType::Point, &LightSpec::type), 2);
  EXPECT_EQ(countContaining(s.warnings, "skies and suns shine once"), 1u);
}

TEST_F(Overlay, ALensIsScaledWithItsFile) {
  write("sub/lens.pbrt",
        "Camera \"perspective\" \"float fov\" 40 \"float lensradius\" 2 \"float focaldistance\" "
        "300\nInclude \"square.pbrt\"\n");
  write("sub/square.pbrt", "WorldBegin\n" + kPbrtSquare);
  const Camera camera = load(mesh("lens.pbrt", "scale = 0.01\n")).camera;
  EXPECT_NEAR(camera.lensRadius, 0.02f, 1e-6f);
  EXPECT_NEAR(camera.focusDistance, 3.0f, 1e-5f);
  EXPECT_NE(loadError(mesh("lens.pbrt", "scale = 1e8\n")).find("lens"), std::string::npos);
}

// The picture stays the same by this. A height in texels has no scale.
TEST_F(Overlay, ABumpIsScaledWithItsFile) {
  write("sub/bumpy.toml",
        "[[texture]]\nname = \"t\"\ntype = \"image\"\nimage = \"dot.tga\"\n"
        "[[material]]\nname = \"paint\"\nmodel = \"diffuse\"\nbump_map = \"t\"\n"
        "relief_strength = 2\ncoat_bump_map = \"t\"\ncoat_bump_in_texels = true\n"
        "coat_relief_strength = 2\n[[mesh]]\nfile = \"square.obj\"\n");
  const Scene s = load(kFilmAndCamera + mesh("bumpy.toml", "scale = 0.5\n"));
  EXPECT_FLOAT_EQ(materialNamed(s, "paint").relief.strength, 1.0f);
  EXPECT_FLOAT_EQ(materialNamed(s, "paint").coatRelief.strength, 2.0f);
}

TEST_F(Overlay, TheFiltersOfFilesCountUnlessTheFilmNamesOne) {
  write("sub/soft.pbrt", "PixelFilter \"gaussian\"\nInclude \"room.pbrt\"\n");
  const FilterSpec gaussian{FilterKind::Gaussian, 1.5f}, mitchell{FilterKind::Mitchell, 1.0f};
  EXPECT_EQ(load(mesh("soft.pbrt")).film.filter, gaussian);
  EXPECT_EQ(load(kFilmAndCamera + mesh("soft.pbrt")).film.filter, gaussian);
  EXPECT_EQ(load(mesh("square.obj")).film.filter, FilterSpec());
  const std::string film = "[film]\nfilter = \"mitchell\"\nfilter_radius = 1\n";
  const Scene other = load(film + mesh("soft.pbrt") + mesh("room.glb"));
  EXPECT_EQ(other.film.filter, mitchell);
  EXPECT_EQ(other.film.width, 20u) << "that of the file";
  EXPECT_EQ(other.views.at(1).film.filter, mitchell);
  EXPECT_EQ(other.views.at(1).film.width, 960u);
  EXPECT_EQ(load("[film]\nfilter = \"blackman-harris\"\n" + mesh("room.glb")).film.filter,
            (FilterSpec{FilterKind::BlackmanHarris, 1.5f}));
  Scene viewed = loadFile("sub/soft.pbrt");
  write("view.toml", kFilmAndCamera);
  useViewFile(at("view.toml"), viewed);
  EXPECT_EQ(viewed.film.filter, gaussian);
  EXPECT_EQ(viewed.film.width, 8u);
  for (const auto& [text, part] : {std::pair{"filter = \"sinc\"", "blackman-harris"},
                                   {"filter_radius = 1", "without 'filter'"},
                                   {"filter = \"box\"\nfilter_radius = 9", "outside 0.25 to 8"},
                                   {"filter = \"box\"\nwidth = 8", "height"}})
    EXPECT_TRUE(loadError("[film]\n" + std::string(text) + "\n" + mesh("room.glb")).find(part) !=
                std::string::npos)
        << text;
}

TEST_F(Overlay, ASceneWithoutCameraIsSeenAsAWhole) {
  for (const Scene& s : {load(mesh("square.obj")), loadFile("sub/square.obj")}) {
    EXPECT_EQ(countContaining(s.warnings, "has no camera; one is placed that sees"), 1u);
    EXPECT_LT(dot(s.camera.position, s.camera.forward), 0.0f);
  }
  // A film that is higher than wide sees all of it, too.
  const Scene tall = load("[film]\nwidth = 10\nheight = 40\n" + mesh("square.obj"));
  const Vec3 to = Vec3(1, 1, 0) - tall.camera.position;
  EXPECT_LT(std::fabs(dot(to, tall.camera.right)) / dot(to, tall.camera.forward),
            0.25f * std::tan(0.5f * tall.camera.verticalFovRad));
}

// Turned by 90 degrees about y and twice as large: light at the surfaces stays the same.
TEST_F(Overlay, CamerasAndLightsMoveWithTheirFile) {
  const std::string place = "rotate_deg = [0, 90, 0]\nscale = 2\ntranslate = [0, 0, 1]\n";
  const Scene s = load(mesh("room.glb", place) + mesh("room.pbrt", place));
  ASSERT_EQ(s.lights.size(), 2u);
  EXPECT_LT(length(s.lights[0].position - Vec3(0, 2, 1)), 1e-6f);
  EXPECT_NEAR(s.lights[0].emission.x, 4.0f, 1e-5f);
  EXPECT_EQ(s.lights[0].name, "Lamp");
  EXPECT_LT(length(s.lights[1].direction - Vec3(0, -1, 0)), 1e-6f);
  EXPECT_NEAR(s.lights[1].emission.x, 1.0f, 1e-6f);
  EXPECT_LT(length(s.views[0].camera.position - Vec3(10, 0, 1)), 1e-5f);
  EXPECT_LT(length(s.views[0].camera.forward - Vec3(-1, 0, 0)), 1e-6f);
  EXPECT_LT(length(s.views[0].camera.right - Vec3(0, 0, -1)), 1e-6f);
  EXPECT_LT(length(s.views[0].camera.up - Vec3(0, 1, 0)), 1e-6f);
  const Scene mirrored = load(mesh("room.glb", "scale = [-1, 1, 1]\n"));
  EXPECT_TRUE(mirrored.camera.isMirrored());
}

TEST_F(Overlay, EnvironmentImagesTurnAboutY) {
  write("sub/sky.toml",
        "[[mesh]]\nfile = \"square.obj\"\n[[light]]\ntype = \"environment\"\n"
        "image = \"dot.tga\"\nrotate_deg = 10\n");
  const Scene s = load(mesh("sky.toml", "rotate_deg = [0, 30, 0]\nscale = 2\n"));
  EXPECT_NEAR(s.lights.at(0).rotateRad, 40.0 * 3.14159265 / 180.0, 1e-6);
  EXPECT_EQ(s.lights[0].scale, 1.0f);
  EXPECT_EQ(countContaining(s.warnings, "environment image"), 0u);
  const Scene tilted = load(mesh("sky.toml", "rotate_deg = [30, 0, 0]\n"));
  EXPECT_EQ(countContaining(tilted.warnings, "environment image turns only about +y"), 1u);
}

TEST_F(Overlay, AFileMayStandAtSeveralPlaces) {
  const Scene s = load(kFilmAndCamera + mesh("room.glb",
                                             "scale = 2\n[[mesh.instance]]\nname = \"left\"\n"
                                             "[[mesh.instance]]\ntranslate = [5, 0, 0]\n"));
  EXPECT_EQ(s.triangles.size(), 1u);
  ASSERT_EQ(s.instances.size(), 2u);
  EXPECT_EQ(s.bounds.upper, Vec3(7, 2, 0));
  EXPECT_EQ(s.objectNames.at(s.objectOf(0, 0)), "left");
  EXPECT_EQ(s.objectNames.at(s.objectOf(0, 1)), "Wall");
  ASSERT_EQ(s.lights.size(), 2u);
  EXPECT_LT(length(s.lights[1].position - Vec3(5, 2, 0)), 1e-6f);
  EXPECT_NEAR(s.lights[1].emission.x, 4.0f, 1e-5f);
  // Files within files with instances.
  write("sub/two.toml",
        "[[mesh]]\nfile = \"room.glb\"\n[[mesh.instance]]\n[[mesh.instance]]\n"
        "translate = [3, 0, 0]\n[[mesh]]\nfile = \"square.obj\"\n"
        "translate = [1, 0, 0]\n");
  const Scene nested = load(kFilmAndCamera + mesh("two.toml",
                                                  "scale = 2\n[[mesh.instance]]\n"
                                                  "[[mesh.instance]]\n"
                                                  "translate = [0, 9, 0]\n"));
  EXPECT_EQ(nested.triangles.size(), 3u);
  EXPECT_EQ(nested.instances.size(), 6u);
  EXPECT_EQ(nested.bounds.lower, Vec3(0, -2, 0));
  EXPECT_EQ(nested.bounds.upper, Vec3(8, 11, 0));
  EXPECT_EQ(nested.lights.size(), 4u);
}

TEST_F(Overlay, MaterialsAreReplacedByName) {
  const std::string paint =
      "[[material]]\nname = \"paint\"\nmodel = \"diffuse\"\nreflectance = [0.1, 0.2, 0.3]\n";
  for (const char* name : {"room.glb", "room.pbrt", "square.obj"}) {
    const Scene s = load(kFilmAndCamera + paint + mesh(name));
    const Material& m = s.materials.at(s.triangles.at(0).material);
    EXPECT_EQ(std::get<DiffuseModel>(m.model).reflectance.value, Vec3(0.1f, 0.2f, 0.3f)) << name;
    EXPECT_EQ(countContaining(s.warnings, "no effect"), 0u) << name;
  }
  EXPECT_EQ(countContaining(load(kFilmAndCamera +
                                 "[[material]]\nname = \"pain\"\nmodel = "
                                 "\"diffuse\"\n" +
                                 mesh("room.glb"))
                                .warnings,
                            "'pain' has no effect: no mesh has a material of that name"),
            1u);
}

// A pbrt lamp is a shape; the material that it has is another matter.
TEST_F(Overlay, LampsOfPbrtShineWithAReplacedMaterial) {
  write("sub/room.pbrt",
        "WorldBegin\nMakeNamedMaterial \"paint\" \"string type\" \"diffuse\"\n"
        "NamedMaterial \"paint\"\n" +
            kPbrtSquare + "AreaLightSource \"diffuse\" \"rgb L\" [1 2 3]\nTranslate 0 0 1\n" +
            kPbrtSquare);
  const std::string paint =
      "[[material]]\nname = \"paint\"\nmodel = \"diffuse\"\n"
      "reflectance = [0.1, 0.2, 0.3]\n";
  const Scene s = load(paint + mesh("room.pbrt"));
  const auto material = [&](uint32_t t) { return s.materials.at(s.triangles.at(t).material); };
  for (const uint32_t t : {0u, 2u}) {
    EXPECT_EQ(std::get<DiffuseModel>(material(t).model).reflectance.value, Vec3(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(material(t).emission, t == 0 ? Vec3(0) : Vec3(1, 2, 3));
  }
  const Scene dark = load(paint + "emission = [7, 7, 7]\n" + mesh("room.pbrt"));
  EXPECT_EQ(dark.materials.at(dark.triangles.at(2).material).emission, Vec3(7, 7, 7));
}

TEST_F(Overlay, OuterReplacementsComeFirstAndInnerOnesStayWithin) {
  write("sub/inner.toml",
        "[[material]]\nname = \"paint\"\nmodel = \"diffuse\"\n"
        "reflectance = [1, 0, 0]\n[[mesh]]\nfile = \"square.obj\"\n");
  const auto red = [](const Scene& s, uint32_t t) {
    const auto* m = std::get_if<DiffuseModel>(&s.materials.at(s.triangles.at(t).material).model);
    return m ? m->reflectance.value.x : -1.0f;
  };
  const Scene inner = load(kFilmAndCamera + mesh("inner.toml") + mesh("square.obj"));
  EXPECT_EQ(red(inner, 0), 1.0f);
  EXPECT_EQ(red(inner, 2), -1.0f);
  const Scene outer = load(kFilmAndCamera +
                           "[[material]]\nname = \"paint\"\nmodel = \"diffuse\"\n"
                           "reflectance = [0.5, 0, 0]\n" +
                           mesh("inner.toml") + mesh("square.obj"));
  EXPECT_EQ(red(outer, 0), 0.5f);
  EXPECT_EQ(red(outer, 2), 0.5f);
}

TEST_F(Overlay, WhatCannotBeIncludedIsRefusedWithItsLine) {
  const auto refused = [&](const std::string& toml, const std::vector<std::string>& parts) {
    const std::string error = loadError(toml);
    for (const std::string& p : parts)
      EXPECT_NE(error.find(p), std::string::npos) << p << " not in: " << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  };
  refused(mesh("none.glb"), {"scene.toml:2: [[mesh]]: ", "none.glb", "no such file"});
  refused(mesh("room.blend"), {"scene.toml:2: [[mesh]]: ", "room.blend", "export it as glTF"});
  refused(mesh("room.glb", "materials = \"square.mtl\"\n"), {"scene.toml:3: ", "[[material]]"});
  refused("[[mesh]]\nfile = \"scene.toml\"\n", {"scene.toml:2: ", "includes itself"});
  write("sub/a.toml", "[[mesh]]\nfile = \"b.toml\"\n");
  write("sub/b.toml", "[[mesh]]\nfile = \"../sub/./a.toml\"\n");
  refused(mesh("a.toml"), {"b.toml:2: [[mesh]]: ", "a.toml includes itself"});
  for (int i = 0; i < 20; ++i)
    write("d" + std::to_string(i) + ".toml",
          "[[mesh]]\nfile = \"d" + std::to_string(i + 1) + ".toml\"\n");
  refused("[[mesh]]\nfile = \"d0.toml\"\n", {"d15.toml:2: ", "16 files deep"});
  write("sub/bad.pbrt", "WorldBegin\nShape \"sphere\" \"float radius\" -1\n");
  refused(mesh("bad.pbrt"), {"bad.pbrt:2:", "'radius' is -1"});
}

TEST_F(Overlay, DefinesReachIncludedFiles) {
  write("sub/inner.toml", "[[mesh]]\nfile = \"${WHICH}.obj\"\n");
  EXPECT_EQ(load(kFilmAndCamera + mesh("inner.toml"), {{"WHICH", "square"}}).triangles.size(), 2u);
}

// The cure of a dark scene is a command that makes a scene.toml.
TEST_F(Overlay, DarkFilesSayHowToLightThem) {
  const std::string said = loadFile("sub/square.obj").noLight();
  EXPECT_NE(said.find("mesh = [{file = \"square.obj\"}]\\nlight = [{type"), said.npos) << said;
  write("sub/square-lit.toml",
        "mesh = [{file = \"square.obj\"}]\nlight = [{type = \"environment\", radiance = [1, 1, "
        "1]}]\n");
  EXPECT_TRUE(loadFile("sub/square-lit.toml").hasLight());
  EXPECT_NE(load(mesh("square.obj")).noLight().find("add a [[light]]"), said.npos);
}

}  // namespace
}  // namespace bnvpl
