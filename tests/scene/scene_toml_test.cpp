// Every mistake in a scene.toml is reported in one line with file, line, section and remedy.
#include "scene/scene_hash.h"
#include "tests/scene/scene_files.h"
#include "transport/camera.h"

namespace bnvpl {
namespace {

class SceneToml : public SceneFiles {
 protected:
  void SetUp() override {
    write("square.obj", kSquareObj);
    write("square.mtl", "newmtl paint\nKd 1 1 1\n");
  }
  // Expects an error on one line that names the file, the line and every part.
  void expectError(const std::string& toml, int line, const std::vector<std::string>& parts) const {
    const std::string error = loadError(toml);
    EXPECT_NE(error, "") << "no error for:\n" << toml;
    if (line > 0) {
      EXPECT_NE(error.find("scene.toml:" + std::to_string(line) + ": "), std::string::npos)
          << error;
    }
    EXPECT_NE(error.find("scene.toml"), std::string::npos) << error;
    for (const std::string& p : parts)
      EXPECT_NE(error.find(p), std::string::npos) << p << " not in: " << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  }
  const std::string mesh_ = "[[mesh]]\nfile = \"square.obj\"\n";
  const std::string base_ = kFilmAndCamera + mesh_;  // 9 lines
};

TEST_F(SceneToml, LoadsAsWritten) {
  const Scene scene =
      load(base_ +
           "[[light]]\ntype = \"spot\"\nposition = [1, 2, 3]\ndirection = [0, -2, 0]\n"
           "intensity = [4.0, 5, 6]\ncone_deg = 30\nfalloff_deg = 10\n");
  EXPECT_EQ(scene.film.width, 8u);
  EXPECT_EQ(scene.film.height, 6u);
  EXPECT_EQ(scene.camera.forward, Vec3(0, 0, -1));
  EXPECT_EQ(scene.camera.right, Vec3(1, 0, 0));
  EXPECT_EQ(scene.camera.up, Vec3(0, 1, 0));
  EXPECT_NEAR(scene.camera.verticalFovRad, 40.0 * 3.14159265 / 180.0, 1e-6);
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.lights[0].type, LightType::Spot);
  EXPECT_EQ(scene.lights[0].direction, Vec3(0, -1, 0));
  EXPECT_EQ(scene.lights[0].emission, Vec3(4, 5, 6));
  EXPECT_NEAR(scene.lights[0].coneRad, 30.0 * 3.14159265 / 180.0, 1e-6);
  EXPECT_NEAR(scene.lights[0].falloffRad, 10.0 * 3.14159265 / 180.0, 1e-6);
}

TEST_F(SceneToml, UnknownKeysNameTheNearest) {
  expectError("[film]\nwidth = 8\nheigth = 6\n", 3,
              {"[film]", "unknown key 'heigth'", "did you mean 'height'"});
  expectError(base_ + "matrials = \"a.mtl\"\n", 10, {"[[mesh]]", "'matrials'", "'materials'"});
  expectError(base_ + "[[light]]\ntype = \"point\"\npositon = [0,0,0]\n", 12,
              {"'positon'", "'position'"});
  expectError("[films]\n" + base_, 0, {"unknown key 'films'", "'film'"});
  // No key is similar.
  expectError(base_ + "[[light]]\ntype = \"point\"\nwattage = 3\n", 12,
              {"unknown key 'wattage'; the keys here are ", "intensity"});
  expectError("[camera]\nfov = 3\n" + base_.substr(0, 0) + "[film]\nwidth = 8\nheight = 6\n", 2,
              {"'fov'"});
}

TEST_F(SceneToml, WrongTypes) {
  expectError("[film]\nwidth = \"8\"\nheight = 6\n", 2, {"'width' must be a whole number"});
  expectError("[film]\nwidth = 8.5\nheight = 6\n", 2, {"'width' must be a whole number"});
  expectError("[film]\nwidth = 0\nheight = 6\n", 2, {"from 1 to"});
  expectError("[film]\nwidth = 8\nheight = -6\n", 3, {"'height'"});
  expectError(kFilmAndCamera + "[[mesh]]\nfile = 3\n", 9, {"'file' must be a text"});
  expectError(base_ + "translate = [1, 2]\n", 10, {"'translate' must be [x, y, z]"});
  expectError(base_ + "translate = [1, 2, \"3\"]\n", 10, {"'translate' must be a number"});
  expectError(base_ + "translate = [1, 2, true]\n", 10, {"'translate' must be a number"});
  expectError(base_ + "translate = [1, 2, nan]\n", 10, {"'translate' must be a number"});
  expectError(base_ + "scale = \"big\"\n", 10, {"'scale' must be a number"});
  expectError(kFilmAndCamera + "[mesh]\nfile = \"square.obj\"\n", 8, {"[[mesh]]"});
  expectError("film = 3\n[camera]\n", 0, {"[film]"});
}

TEST_F(SceneToml, MissingSectionsAndKeys) {
  expectError("", 0, {"has no triangle"});
  expectError("[film]\nwidth = 8\n", 1, {"needs 'height'"});
  expectError(kFilmAndCamera, 0, {"no triangle"});
  expectError(kFilmAndCamera + "[[mesh]]\n", 8, {"needs 'file'"});
  expectError(base_ + "[[light]]\nposition = [0, 0, 0]\n", 10, {"needs 'type'"});
  expectError(base_ + "[[light]]\ntype = \"point\"\nposition = [0, 0, 0]\n", 10,
              {"needs 'intensity'"});
}

TEST_F(SceneToml, CameraNeedsOneViewingDirection) {
  const std::string film =
      "[film]\nwidth = 8\nheight = 6\n[camera]\nposition = [0, 0, 5]\nvertical_fov_deg = 40\n";
  expectError(film + "look_at = [0, 0, 0]\nforward = [0, 0, -1]\n" + mesh_, 4,
              {"exactly one of 'look_at' and 'forward'"});
  expectError(film + mesh_, 4, {"exactly one of 'look_at' and 'forward'"});
  expectError(film + "look_at = [0, 0, 5]\n" + mesh_, 7, {"'look_at' equals 'position'"});
  expectError(film + "forward = [0, 0, 0]\n" + mesh_, 7, {"'forward' must not be zero"});
  expectError(film + "forward = [0, 1, 0]\n" + mesh_, 4, {"'up' is parallel"});
  EXPECT_EQ(load(film + "forward = [0, 0, -3]\n" + mesh_).camera.forward, Vec3(0, 0, -1));
}

TEST_F(SceneToml, FieldOfViewHasLimits) {
  const std::string film =
      "[film]\nwidth = 8\nheight = 6\n[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\n";
  expectError(film + "vertical_fov_deg = 0\n" + mesh_, 7, {"'vertical_fov_deg' is 0"});
  expectError(film + "vertical_fov_deg = 180\n" + mesh_, 7, {"'vertical_fov_deg' is 180"});
  expectError(film + "vertical_fov_deg = true\n" + mesh_, 7,
              {"'vertical_fov_deg' must be a number"});
}

TEST_F(SceneToml, ALensNeedsRadiusAndDistance) {
  const std::string lens =
      "[film]\nwidth = 8\nheight = 6\n[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\n"
      "vertical_fov_deg = 40\n";
  const Camera camera = load(lens + "lens_radius = 0.25\nfocus_distance = 4\n" + mesh_).camera;
  EXPECT_EQ(camera.lensRadius, 0.25f);
  EXPECT_EQ(camera.focusDistance, 4.0f);
  EXPECT_FALSE(load(lens + mesh_).camera.hasLens());
  EXPECT_FALSE(load(lens + "lens_radius = 0\n" + mesh_).camera.hasLens());
  expectError(lens + "lens_radius = -1\nfocus_distance = 4\n" + mesh_, 8,
              {"'lens_radius' must not be negative, but is -1"});
  expectError(lens + "lens_radius = 1\n" + mesh_, 8, {"'lens_radius' needs 'focus_distance'"});
  expectError(lens + "lens_radius = 1\nfocus_distance = 0\n" + mesh_, 9,
              {"'focus_distance' is 0, outside 1e-09 to 1e+09"});
  expectError(lens + "focus_distance = 4\n" + mesh_, 8, {"no effect without 'lens_radius'"});
  expectError(lens + "lens_radius = 1\nfocal_distance = 4\n" + mesh_, 9,
              {"did you mean 'focus_distance'?"});
}

TEST_F(SceneToml, LightKeysBelongToTheirType) {
  const std::string point =
      base_ + "[[light]]\ntype = \"point\"\nposition = [0, 0, 0]\nintensity = [1, 1, 1]\n";
  expectError(point + "cone_deg = 30\n", 14, {"'cone_deg' has no meaning for a point light"});
  expectError(point + "direction = [0, 0, 1]\n", 14, {"'direction' has no meaning"});
  const std::string sun =
      base_ + "[[light]]\ntype = \"directional\"\ndirection = [0, -1, 0]\nirradiance = [1, 1, 1]\n";
  expectError(sun + "intensity = [1, 1, 1]\n", 14,
              {"'intensity' has no meaning for a directional light"});
  const std::string sky = base_ + "[[light]]\ntype = \"environment\"\nradiance = [1, 1, 1]\n";
  expectError(sky + "position = [1, 1, 1]\n", 13,
              {"'position' has no meaning for a environment light"});
  expectError(sky + "image = \"a.exr\"\n", 10, {"exactly one of 'radiance' and 'image'"});
  expectError(base_ + "[[light]]\ntype = \"lamp\"\n", 11,
              {"unknown type 'lamp'", "point, spot, sun, directional"});
  EXPECT_NE(loadError(base_ + "[[light]]\ntype = \"environment\"\nimage = \"gone.exr\"\n")
                .find("gone.exr: "),
            std::string::npos);
}

TEST_F(SceneToml, LightValuesHaveLimits) {
  const std::string spot =
      base_ + "[[light]]\ntype = \"spot\"\nposition = [0, 0, 0]\ndirection = [0, 0, 1]\n";
  expectError(spot + "intensity = [1, -1, 1]\ncone_deg = 30\n", 14,
              {"'intensity' must not be negative"});
  expectError(spot + "intensity = [1, 1, 1]\ncone_deg = 0\n", 15, {"'cone_deg'"});
  expectError(spot + "intensity = [1, 1, 1]\ncone_deg = 30\nfalloff_deg = 31\n", 16,
              {"exceeds 'cone_deg'"});
}

TEST_F(SceneToml, SyntaxErrorsHaveALine) {
  expectError("[film]\nwidth = = 8\n", 2, {});
  expectError("[film\n", 1, {});
}

TEST_F(SceneToml, DefinesFillFileNames) {
  write("far away/square.obj", kSquareObj);
  const std::string toml = kFilmAndCamera + "[[mesh]]\nfile = \"${BNVPL_TEST_DIR}/square.obj\"\n";
  EXPECT_EQ(load(toml, {{"BNVPL_TEST_DIR", at("far away").string()}}).triangles.size(), 2u);
  EXPECT_EQ(load(toml, {{"BNVPL_TEST_DIR", "far away"}}).triangles.size(),
            2u);  // relative to the scene
  expectError(toml, 9, {"${BNVPL_TEST_DIR} is not set", "--define BNVPL_TEST_DIR="});
  ::setenv("BNVPL_TEST_DIR", "nowhere", 1);
  EXPECT_NE(loadError(toml).find("nowhere/square.obj"), std::string::npos);
  EXPECT_EQ(load(toml, {{"BNVPL_TEST_DIR", "far away"}}).triangles.size(), 2u);  // a define wins
  ::unsetenv("BNVPL_TEST_DIR");
}

TEST_F(SceneToml, MissingSceneFile) {
  try {
    loadScene(at("absent.toml"));
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("absent.toml: no such file"), std::string::npos)
        << e.what();
  }
}

TEST(Camera, FilmCornersAndBack) {
  Camera camera;
  camera.position = {1, 2, 3};
  camera.verticalFovRad = 1.5707963f;
  const Film film{200, 100};
  const Vec3 corner = cameraDirection(camera, film, 0, 0);
  EXPECT_NEAR(corner.x / -corner.z, -2.0f, 1e-5f);  // 2 : 1, and 45 degrees up
  EXPECT_NEAR(corner.y / -corner.z, 1.0f, 1e-5f);
  EXPECT_NEAR(length(corner), 1.0f, 1e-6f);
  const RasterPoint back = projectToFilm(
      camera, film, camera.position + 7.0f * cameraDirection(camera, film, 0.2f, 0.9f));
  EXPECT_NEAR(back.x, 0.2f, 1e-5f);
  EXPECT_NEAR(back.y, 0.9f, 1e-5f);
  EXPECT_LT(projectToFilm(camera, film, {1, 2, 4}).depth, 0.0f);
}

// Rays from all over the lens meet in the plane in focus; along each, projectToFilm() is the
// inverse.
TEST(Camera, RaysThroughALens) {
  Camera camera;
  camera.position = {1, 2, 3};
  camera.shift = {0.1f, -0.2f};
  camera.lensRadius = 0.5f;
  camera.focusDistance = 4.0f;
  const Film film{200, 100};
  const Vec3 inFocus = camera.position + 4.0f * filmAtUnitDepth(camera, film, 0.2f, 0.9f);
  for (const Point2 u : {Point2{0.5f, 0.5f}, {0.0f, 0.3f}, {0.9f, 0.6f}}) {
    const Vec3 lens = sampleLens(camera, [&] { return u; });
    EXPECT_LE(length(lens), 0.5f + 1e-6f);
    EXPECT_EQ(dot(lens, camera.forward), 0.0f);
    const Ray ray = cameraRay(camera, film, 0.2f, 0.9f, lens);
    EXPECT_EQ(ray.origin, camera.position + lens);
    EXPECT_LT(length(cross(inFocus - ray.origin, ray.direction)), 1e-5f);
    for (const float distance : {0.5f, 20.0f}) {
      const RasterPoint back =
          projectToFilm(camera, film, ray.origin + distance * ray.direction, lens);
      EXPECT_NEAR(back.x, 0.2f, 1e-5f);
      EXPECT_NEAR(back.y, 0.9f, 1e-5f);
      EXPECT_NEAR(back.depth, distance * dot(ray.direction, camera.forward), 1e-5f);
    }
  }
  camera.lensRadius = 0.0f;
  EXPECT_EQ(sampleLens(camera, []() -> Point2 { throw 1; }), Vec3());
}

// The record of an image tells one lens from another, and a pinhole has no distance.
TEST(Camera, TheHashOfAViewFollowsTheLens) {
  Camera camera;
  const Film film{8, 6};
  const uint64_t pinhole = hashView(camera, film);
  camera.focusDistance = 3.0f;
  EXPECT_EQ(hashView(camera, film), pinhole);
  camera.lensRadius = 0.5f;
  const uint64_t lens = hashView(camera, film);
  EXPECT_NE(lens, pinhole);
  camera.focusDistance = 2.0f;
  EXPECT_NE(hashView(camera, film), lens);
}

TEST_F(SceneToml, BackslashesOfFileNamesCountAsSlashes) {
  write("square.obj", kSquareObj);
  write("square.mtl", "newmtl paint\nKd 1 1 1\n");
  const std::string mesh = kFilmAndCamera + "[[mesh]]\nfile = ";
  EXPECT_EQ(load(mesh + "'.\\square.obj'\n").triangles.size(), 2u);
  EXPECT_EQ(load(mesh + "\".\\\\square.obj\"\n").triangles.size(), 2u);
  const std::string cure = "write / in file names, or put them in '...'";
  EXPECT_NE(loadError(mesh + "\".\\square.obj\"\n").find(cure), std::string::npos);
  EXPECT_NE(loadError(mesh + "\".\\new.obj\"\n").find(cure), std::string::npos);
}

TEST_F(SceneToml, AMaterialReplacesThatOfItsName) {
  const Scene scene = load(base_ +
                           "[[material]]\nname = \"base\"\nmodel = \"diffuse\"\n"
                           "[[material]]\nname = \"paint\"\nmodel = \"mix\"\nfirst = \"base\"\n"
                           "second = \"base\"\namount = 0.25\nemission = [1, 2, 3]\n"
                           "emission_sides = 2\nopacity = 0.75\nopacity_cutoff = 0.25\n");
  ASSERT_EQ(scene.materials.size(), 2u);
  EXPECT_TRUE(scene.warnings.empty());
  const Material& m = scene.materials[scene.triangles[0].material];
  EXPECT_EQ(m.name, "paint");
  EXPECT_EQ(std::get<MixModel>(m.model).amount.value, 0.25f);
  EXPECT_EQ(std::get<MixModel>(m.model).first, 0u);
  EXPECT_EQ(m.emission, Vec3(1, 2, 3));
  EXPECT_TRUE(m.twoSidedEmission);
  EXPECT_EQ(m.opacity, 0.75f);
  EXPECT_EQ(m.opacityCutoff, 0.25f);
}

TEST_F(SceneToml, AnEmissionTextureAloneShines) {
  const std::string texture =
      "[[texture]]\nname = \"t\"\ntype = \"constant\"\nvalue = [1, 2, 3]\n"
      "[[material]]\nname = \"paint\"\nmodel = \"diffuse\"\nemission_texture = \"t\"\n";
  EXPECT_EQ(materialNamed(load(base_ + texture), "paint").emission, Vec3(1, 2, 3));
  const Scene dark = load(base_ + texture + "emission = [0, 0, 0]\n");
  EXPECT_EQ(materialNamed(dark, "paint").emission, Vec3());
}

TEST_F(SceneToml, AnEmissionTextureWithoutItsImageIsDark) {
  const Scene scene =
      load(base_ +
           "[[texture]]\nname = \"t\"\ntype = \"image\"\nimage = \"missing.png\"\n"
           "[[material]]\nname = \"paint\"\nmodel = \"diffuse\"\nemission_texture = \"t\"\n");
  EXPECT_EQ(materialNamed(scene, "paint").emission, Vec3());
  EXPECT_EQ(countContaining(scene.warnings, "does not shine"), 1u);
}

TEST_F(SceneToml, AMaterialThatNoFaceHasIsNamed) {
  const Scene scene = load(base_ + "[[material]]\nname = \"pain\"\nmodel = \"diffuse\"\n");
  ASSERT_EQ(scene.warnings.size(), 2u);  // the other one: no light
  EXPECT_NE(scene.warnings[0].find("[[material]] 'pain' has no effect"), std::string::npos)
      << scene.warnings[0];
}

TEST_F(SceneToml, MistakesInMaterialsAndTextures) {
  const std::string material = base_ + "[[material]]\nname = \"paint\"\n";  // 11 lines
  expectError(material, 10, {"[[material]]", "needs 'model'"});
  expectError(material + "model = \"phong\"\n", 12, {"'phong'", "use one of coated_conductor, ", " diffuse, ", ", mix"});
  expectError(material + "model = \"diffuse\"\nreflectence = [1, 1, 1]\n", 13,
              {"did you mean 'reflectance'"});
  expectError(material + "model = \"diffuse\"\neta = [1, 1, 1]\n", 13, {"'eta'"});
  expectError(material + "model = \"diffuse\"\nreflectance_texture = \"t\"\n", 13,
              {"no [[texture]] 't' stands before this"});
  expectError(material + "model = \"mix\"\nfirst = \"paint\"\n", 13,
              {"no [[material]] 'paint' stands before this"});
  expectError(material + "model = \"mix\"\n", 10, {"[[material]]", "needs 'first'"});
  expectError(material + "model = \"diffuse\"\nemission_sides = 3\n", 13, {"from 1 to 2"});
  expectError(material + "model = \"dielectric\"\nthin = 1\n", 13, {"true or false"});
  expectError(material + "model = \"diffuse\"\n[[material]]\nname = \"paint\"\nmodel = \"mix\"\n",
              14, {"'paint' was given before"});
  const std::string texture = base_ + "[[texture]]\nname = \"t\"\n";
  expectError(texture + "type = \"picture\"\n", 12, {"use one of constant, image"});
  expectError(texture + "type = \"constant\"\nvalue = [1e7, 1, 1]\n", 13, {"1e+06"});
  expectError(texture + "type = \"constant\"\nvalue = [1, 1, 1]\nimage = \"a\"\n", 14,
              {"'image' has no meaning for a texture of type constant"});
  expectError(texture + "type = \"image\"\nimage = \"a\"\nuv_transform = [[1, 0], [0, 1]]\n", 14,
              {"two rows of three numbers"});
}

TEST_F(SceneToml, InstancesPlaceAMesh) {
  const Scene scene = load(base_ +
                           "scale = 2\n[[mesh.instance]]\ntranslate = [1, 0, 0]\n"
                           "[[mesh.instance]]\nscale = [1, -1, 1]\n");
  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.bounds.lower, Vec3(-2, -2, 0));
  EXPECT_EQ(scene.bounds.upper, Vec3(3, 2, 0));
  EXPECT_EQ(scene.instances[1].mirrored, 1u);
  expectError(base_ + "instance = 3\n", 10, {"[[mesh.instance]]"});
  expectError(base_ + "[[mesh.instance]]\nfile = \"a.obj\"\n", 11, {"unknown key 'file'"});
}

TEST_F(SceneToml, AMirroredCameraSwapsLeftAndRight) {
  std::string text = base_;
  text.replace(text.find("vertical_fov"), 0, "mirrored = true\n");
  const Camera c = load(text).camera;
  EXPECT_EQ(c.right, Vec3(-1, 0, 0));
  EXPECT_EQ(c.up, Vec3(0, 1, 0));
  text.replace(text.find("true"), 4, "1");
  expectError(text, 7, {"[camera]", "true or false"});
}

}  // namespace
}  // namespace bnvpl
