// Guarantees of SceneBuilder to loaders of any format, and the choice of a loader.
#include <algorithm>

#include "core/random.h"
#include "scene/builder/scene_builder.h"
#include "scene/scene_hash.h"
#include "tests/scene/builder_fixture.h"
#include "transport/accelerator/accelerator.h"

namespace bnvpl {
namespace {

TEST_F(Builder, MakesWhatAFileSays) {
  write("square.tga", tga(1, 1, {{255, 0, 0, 255}}));
  const Scene loaded = loadMesh(
      kSquareObj, "newmtl paint\nKd .5 .5 .5\nmap_Kd square.tga\n", "translate = [0, 0, 0.5]\n",
      "[[light]]\ntype = \"point\"\nposition = [0, 0, 2]\nintensity = [1, 2, 3]\n");

  SceneBuilder builder(at("scene.toml"));
  builder.setFilm({8, 6});
  Camera camera;
  camera.verticalFovRad = loaded.camera.verticalFovRad;
  builder.setCamera({0, 0, 5}, camera);
  Material paint;
  paint.name = "paint";
  paint.phong().diffuse = Vec3(.5f);
  paint.phong().diffuseMap = builder.addTexture({.file = at("square.tga")});
  paint.phong().exponent = 1.0f;  // default of an MTL without Ns
  const uint32_t number = builder.addMaterial(paint);
  const std::vector<double> positions{-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
  const std::vector<double> uvs{0, 0, 1, 0, 1, 1, 0, 1};
  Mesh mesh{positions, {}, uvs, {}};
  for (const auto& c : {std::array<uint32_t, 3>{0, 1, 3}, {1, 2, 3}})
    mesh.triangles.push_back({c, kNoCorners, c, number});
  Affine up;
  up.m[2][3] = 0.5;
  EXPECT_EQ(builder.addMesh("square.obj", mesh, up), 0u);
  LightSpec point;
  point.emission = {1, 2, 3};
  builder.addLight(point, {0, 0, 2});
  const Scene built = builder.finish();

  EXPECT_EQ(joined(built.warnings), "");
  ASSERT_EQ(built.triangles.size(), loaded.triangles.size());
  for (uint32_t t = 0; t < 2; ++t) {
    for (size_t k = 0; k < 3; ++k) EXPECT_EQ(built.corner(t, k), loaded.corner(t, k));
  }
  EXPECT_EQ(built.camera.position, loaded.camera.position);
  EXPECT_EQ(built.textures.at(0).rgba, loaded.textures.at(0).rgba);
  EXPECT_EQ(built.positions.size(), 5u);  // and one behind them
  EXPECT_EQ(built.bounds.lower, loaded.bounds.lower);
  EXPECT_EQ(built.contentHash, loaded.contentHash);
  EXPECT_EQ(built.contentHash, hashScene(built));
}

TEST_F(Builder, CountsEveryMeshFromItsOwnArrays) {
  SceneBuilder builder("s");
  const uint32_t lamp = builder.addMaterial(emitterOf(1));
  Affine far;
  far.m[0][3] = 10;
  addTriangle(builder, lamp);
  addTriangle(builder, lamp, far);
  const Scene scene = builder.finish();
  ASSERT_EQ(scene.triangles.size(), 2u);
  EXPECT_EQ(scene.corner(0, 1), Vec3(2, 0, 0));
  EXPECT_EQ(scene.corner(1, 1), Vec3(12, 0, 0));
}

TEST_F(Builder, MirroredMeshesKeepTheirOutside) {
  SceneBuilder builder("s");
  const uint32_t lamp = builder.addMaterial(emitterOf(1));
  addTriangle(builder, lamp);
  addTriangle(builder, lamp, Affine::fromParts({}, {}, {-1, 1, 1}));
  const Scene scene = builder.finish();
  EXPECT_EQ(geometricNormal(scene, 0), Vec3(0, 0, 1));
  EXPECT_EQ(geometricNormal(scene, 1), Vec3(0, 0, 1));
}

TEST_F(Builder, LeavesOutWhatHasNoPlace) {
  SceneBuilder builder("s");
  const uint32_t lamp = builder.addMaterial(emitterOf(1));
  Mesh mesh{kCorners, {}, {}, {}};
  for (const auto& c : {std::array<uint32_t, 3>{0, 1, 2}, {0, 1, 3}, {0, 1, 4}, {0, 1, kNone}})
    mesh.triangles.push_back(corners(c, lamp));
  mesh.triangles.push_back(corners({0, 1, 99}, kNone));
  EXPECT_EQ(builder.addMesh("m.obj", mesh), 0u);  // the triangle without a material is left out
  const Scene scene = builder.finish();
  EXPECT_EQ(scene.triangles.size(), 1u);
  EXPECT_EQ(scene.materials.size(), 1u);
  EXPECT_EQ(countContaining(scene.warnings, "m.obj: 4 triangles with missing or non-finite"), 1u)
      << joined(scene.warnings);
}

TEST_F(Builder, NormalsAreUnitVectorsOrNone) {
  SceneBuilder builder("s");
  const uint32_t lamp = builder.addMaterial(emitterOf(1));
  const std::vector<double> normals{0, 0, 7, 0, 0, 0, NAN, 0, 0};
  Mesh mesh{kCorners, normals, {}, {{{0, 1, 2}, {0, 1, 2}, {7, kNone, 0}, lamp}}};
  builder.addMesh("m.obj", mesh);
  const Scene scene = builder.finish();
  const Triangle& t = scene.triangles.at(0);
  EXPECT_EQ(scene.normals.at(t.normal[0]), Vec3(0, 0, 1));
  EXPECT_EQ(t.normal[1], kNone);
  EXPECT_EQ(t.normal[2], kNone);
  EXPECT_EQ(t.uv, kNoCorners);
}

TEST_F(Builder, GreyIsOneMaterialOfItsOwn) {
  SceneBuilder builder("s");
  builder.addMaterial(emitterOf(1));  // unnamed, too
  EXPECT_EQ(builder.addMesh("a", {kCorners, {}, {}, {corners({0, 1, 2}, kNone)}}), 1u);
  EXPECT_EQ(builder.addMesh("b", {kCorners, {}, {}, {corners({0, 1, 2}, kNone)}}), 1u);
  const Scene scene = builder.finish();
  ASSERT_EQ(scene.materials.size(), 2u);
  for (const Triangle& t : scene.triangles)
    EXPECT_EQ(scene.materials[t.material].phong().diffuse, Vec3(.5f));
}

TEST_F(Builder, OpaqueTrianglesComeFirst) {
  SceneBuilder builder("s");
  Material cut = emitterOf(1);
  cut.opacity = 0.1f;
  const uint32_t masked = builder.addMaterial(cut), opaque = builder.addMaterial(emitterOf(2));
  Affine aside;
  aside.m[0][3] = 5;
  addTriangle(builder, masked);
  addTriangle(builder, opaque, aside);
  const Scene scene = builder.finish();
  EXPECT_EQ(scene.maskedBegin, 1u);
  EXPECT_EQ(scene.triangles.at(0).material, opaque);
}

TEST_F(Builder, TexturesAreNumberedByTheirUse) {
  write("a.tga", tga(1, 1, {{1, 2, 3, 4}}));
  write("bad.tga", "no picture");
  SceneBuilder builder("s");
  builder.expectTexture({.file = at("a.tga")});
  builder.expectTexture({.file = at("nobody-asks-again.tga")});
  Material m = emitterOf(1);
  m.phong().glossyMap = builder.addTexture({.file = at("bad.tga")});
  m.phong().diffuseMap = builder.addTexture({.file = at("a.tga")});
  m.opacityMap = builder.addTexture({.file = at("a.tga"), .srgb = false, .mask = true});
  EXPECT_EQ(builder.addTexture({.file = at("a.tga")}), m.phong().diffuseMap);
  EXPECT_NE(m.opacityMap, m.phong().diffuseMap);
  EXPECT_EQ(builder.addTexture({.file = at("gone.tga")}), kNone);
  addTriangle(builder, builder.addMaterial(m));
  const Scene scene = builder.finish();
  const Material& read = scene.materials.at(0);
  EXPECT_EQ(scene.textures.size(), 2u);
  EXPECT_EQ(read.phong().glossyMap, kNone);
  EXPECT_EQ(read.phong().diffuseMap, 0u);
  EXPECT_EQ(read.opacityMap, 1u);
  EXPECT_FALSE(scene.textures.at(1).srgb);
  for (const char* part : {"bad.tga: cannot read", "gone.tga: no such texture",
                           "m.obj: its material has a texture but faces without texture"}) {
    EXPECT_EQ(countContaining(scene.warnings, part), 1u) << part << joined(scene.warnings);
  }
  std::vector<std::string> files;
  for (const fs::path& f : scene.files) files.push_back(f.filename().string());
  EXPECT_EQ(files, (std::vector<std::string>{"s", "bad.tga", "a.tga", "gone.tga"}));
}

TEST_F(Builder, FarScenesCountFromTheirOwnOriginWithCameraAndLights) {
  SceneBuilder builder("s");
  Affine far;
  far.m[0][3] = 1e6;
  addTriangle(builder, builder.addMaterial(emitterOf(1)), far);
  builder.setCamera({1e6, 1, 3}, {});
  LightSpec light;
  light.emission = Vec3(1);
  builder.addLight(light, {1e6 + 1, 0.25, 0});
  light.type = LightType::Directional;
  builder.addLight(light);
  const Scene scene = builder.finish();
  EXPECT_NE(scene.origin[0], 0.0);
  const auto x = [&](double file) { return static_cast<float>(file - scene.origin[0]); };
  EXPECT_EQ(scene.corner(0, 0).x, x(1e6));
  EXPECT_EQ(scene.camera.position, Vec3(x(1e6), 1, 3));
  EXPECT_EQ(scene.lights.at(0).position, Vec3(x(1e6 + 1), 0.25f, 0));
  EXPECT_EQ(scene.lights.at(1).position, Vec3());  // a light without a position
}

TEST_F(Builder, WarningsAndFilesAreNamedOnce) {
  SceneBuilder builder("s");
  addTriangle(builder, builder.addMaterial(emitterOf(1)));
  builder.setCamera({0, 0, 5}, {});
  for (int i = 0; i < 2; ++i) {
    builder.warn("odd");
    builder.addFile("a");
  }
  const Scene scene = builder.finish();
  EXPECT_EQ(scene.warnings, std::vector<std::string>{"odd"});
  EXPECT_EQ(scene.files, (std::vector<fs::path>{"s", "a"}));
}

TEST_F(Builder, NothingToSeeIsRefused) {
  SceneBuilder builder("s");
  builder.addMesh("m.obj", {kCorners, {}, {}, {corners({0, 1, 1}, kNone)}});
  try {
    builder.finish();
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("s: has no triangle"), std::string::npos) << e.what();
  }
}

TEST_F(Builder, ReportsASceneWithoutLight) {
  const auto warned = [](const Scene& scene) {
    EXPECT_EQ(countContaining(scene.warnings, "s: has no light with power"),
              scene.hasLight() ? 0u : 1u)
        << joined(scene.warnings);
    if (scene.hasLight())
      EXPECT_NO_THROW(scene.requireLight());
    else
      EXPECT_THROW(scene.requireLight(), InputError);
    return !scene.hasLight();
  };
  const auto sceneWith = [&](const Material& used, const Material& unused,
                             const std::vector<LightSpec>& lights) {
    SceneBuilder builder("s");
    addTriangle(builder, builder.addMaterial(used));
    builder.addMaterial(unused);
    for (const LightSpec& light : lights) builder.addLight(light);
    return builder.finish();
  };
  EXPECT_TRUE(warned(sceneWith({}, {}, {})));
  EXPECT_TRUE(warned(sceneWith({}, emitterOf(1), {})));
  EXPECT_FALSE(warned(sceneWith(emitterOf(1e-3f), {}, {})));
  for (const LightType type :
       {LightType::Point, LightType::Spot, LightType::Directional, LightType::Environment}) {
    LightSpec light;
    light.type = type;
    EXPECT_TRUE(warned(sceneWith({}, {}, {light})));
    light.emission = {0, 0, 1e-3f};
    EXPECT_FALSE(warned(sceneWith({}, {}, {LightSpec{}, light})));
    if (type != LightType::Environment) continue;
    light.scale = 0.0f;
    EXPECT_TRUE(warned(sceneWith({}, {}, {light})));
  }
}

TEST_F(Builder, ABlackSkyIsNoLight) {
  write("square.obj", kSquareObj);
  write("square.mtl", "newmtl paint\nKd 1 1 1\n");
  const std::string toml = kFilmAndCamera +
                           "[[mesh]]\nfile = \"square.obj\"\n[[light]]\ntype = \"environment\"\n"
                           "image = \"sky.tga\"\n";
  write("sky.tga", tga(2, 1, {{0, 0, 0, 255}, {0, 0, 0, 255}}));
  EXPECT_FALSE(load(toml).hasLight());
  write("sky.tga", tga(2, 1, {{0, 0, 0, 255}, {0, 0, 1, 255}}));
  EXPECT_TRUE(load(toml).hasLight());
}

TEST_F(Builder, TheExtensionSaysTheFormat) {
  const auto error = [&](const std::string& name) -> std::string {
    try {
      loadScene(at(name));
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  loadMesh(kSquareObj, "");
  fs::copy_file(at("scene.toml"), at("SCENE.TOML"));
  EXPECT_EQ(error("SCENE.TOML"), "");
  EXPECT_EQ(error("room.fbx"), at("room.fbx").string() +
                                   ": is no scene file; scenes are read from .toml, .pbrt, "
                                   ".pbrt.gz, .gltf, .glb, .obj");
  EXPECT_EQ(error("square.obj"), "");
  EXPECT_NE(error("").find("is a folder"), std::string::npos);
}

}  // namespace
}  // namespace bnvpl
