#include "scene/choose_view.h"
#include "scene/scene_hash.h"
#include "tests/scene/gltf/gltf_files.h"

namespace bnvpl {
namespace {

using GltfViews = GltfFiles;

Gltf twoCameras() {
  Gltf g = triangleGltf();
  g.add("cameras",
        "{\"type\":\"perspective\",\"perspective\":{\"yfov\":0.8,\"aspectRatio\":2,"
        "\"znear\":0.1}}");
  g.add("cameras", "{\"type\":\"perspective\",\"perspective\":{\"yfov\":0.5,\"znear\":0.1}}");
  g.show("{\"name\":\"Door\",\"camera\":0,\"translation\":[0,0,5],\"scale\":[3,3,3]}");
  // Half a turn about y makes the camera look along +z.
  g.show("{\"name\":\"Window\",\"camera\":1,\"translation\":[0,0,-5],\"rotation\":[0,1,0,0]}");
  return g;
}

TEST_F(GltfViews, TheFirstCameraIsTheScenes) {
  const Scene s = load(twoCameras());
  EXPECT_EQ(s.camera.position, Vec3(0, 0, 5));
  EXPECT_EQ(s.camera.forward, Vec3(0, 0, -1));
  EXPECT_EQ(s.camera.verticalFovRad, 0.8f);
  EXPECT_EQ(s.film.width, 1080u);
  EXPECT_EQ(s.film.height, 540u);
  ASSERT_EQ(s.views.size(), 2u);
  EXPECT_EQ(cameraList(s), "0 'Door', 1 'Window'");
}

TEST_F(GltfViews, AnotherIsChosenByNameOrNumber) {
  for (const char* choice : {"Window", "1"}) {
    Scene s = load(twoCameras());
    const uint64_t before = hashView(s.camera, s.film);
    chooseCamera(choice, s);
    EXPECT_EQ(s.camera.position, Vec3(0, 0, -5));
    EXPECT_NEAR(s.camera.forward.z, 1.0f, 1e-6f);
    EXPECT_NEAR(s.camera.right.x, -1.0f, 1e-6f);
    EXPECT_EQ(s.film.width, 960u);
    EXPECT_NE(hashView(s.camera, s.film), before);
  }
  Scene s = load(twoCameras());
  for (const char* choice : {"2", "Doors", "", "-1"})
    EXPECT_THROW(chooseCamera(choice, s), UsageError) << choice;
}

TEST_F(GltfViews, AViewFileReplacesThem) {
  write("view.toml", kFilmAndCamera);
  Scene s = load(twoCameras());
  useViewFile(at("view.toml"), s);
  EXPECT_EQ(s.film.width, 8u);
  EXPECT_EQ(s.camera.position, Vec3(0, 0, 5));
  EXPECT_EQ(s.files.back(), at("view.toml"));

  write("view.toml", kFilmAndCamera + "[[mesh]]\nfile = \"a.obj\"\n");
  EXPECT_THROW(useViewFile(at("view.toml"), s), InputError);
}

TEST_F(GltfViews, WithoutACameraTheWholeSceneIsSeen) {
  const Scene s = load(triangleGltf());
  EXPECT_EQ(countContaining(s.warnings, "has no camera"), 1u);
  for (uint32_t k = 0; k < 3; ++k) {
    const Vec3 d = normalize(s.corner(0, k) - s.camera.position);
    EXPECT_GT(dot(d, s.camera.forward), std::cos(0.5f * s.camera.verticalFovRad));
  }
}

TEST_F(GltfViews, OrthographicCamerasAreLeftOut) {
  Gltf g = triangleGltf();
  g.add("cameras",
        "{\"type\":\"orthographic\",\"orthographic\":{\"xmag\":1,\"ymag\":1,"
        "\"zfar\":10,\"znear\":0.1}}");
  g.show("{\"name\":\"Plan\",\"camera\":0}");
  const Scene s = load(g);
  EXPECT_EQ(countContaining(s.warnings, "camera 'Plan' is orthographic"), 1u) << joined(s.warnings);
}

Gltf withLight(const std::string& light) {
  Gltf g = triangleGltf();
  g.show("{\"translation\":[1,2,3],\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}}");
  g.more =
      ",\"extensionsUsed\":[\"KHR_lights_punctual\"],\"extensions\":{\"KHR_lights_punctual\":{"
      "\"lights\":[" +
      light + "]}}";
  return g;
}

TEST_F(GltfViews, CandelaAndLuxBecomeRadiometric) {
  const Scene point =
      load(withLight("{\"type\":\"point\",\"intensity\":1366,\"color\":[1,0.5,0]}"));
  ASSERT_EQ(point.lights.size(), 1u);
  EXPECT_EQ(point.lights[0].type, LightType::Point);
  EXPECT_EQ(point.lights[0].position, Vec3(1, 2, 3));
  EXPECT_EQ(point.lights[0].emission, Vec3(2, 1, 0));
  EXPECT_EQ(countContaining(point.warnings, "range"), 0u);

  const Scene sun = load(withLight("{\"type\":\"directional\",\"intensity\":683}"));
  EXPECT_EQ(sun.lights.at(0).type, LightType::Directional);
  EXPECT_EQ(sun.lights[0].emission, Vec3(1, 1, 1));
  EXPECT_EQ(sun.lights[0].direction, Vec3(0, 0, -1));

  const Scene spot =
      load(withLight("{\"type\":\"spot\",\"range\":5,\"spot\":{"
                     "\"innerConeAngle\":0.2,\"outerConeAngle\":0.5}}"));
  EXPECT_EQ(spot.lights.at(0).type, LightType::Spot);
  EXPECT_FLOAT_EQ(spot.lights[0].coneRad, 0.5f);
  EXPECT_FLOAT_EQ(spot.lights[0].falloffRad, 0.3f);
  EXPECT_EQ(countContaining(spot.warnings, "the range of lights is ignored"), 1u);
  EXPECT_EQ(load(withLight("{\"type\":\"point\",\"range\":3.4e38}")).lights.size(), 1u);
}

// glTF 2.0, 3.10, and KHR_lights_punctual: only the rotation of the node counts.
TEST_F(GltfViews, AScaleOfNothingLeavesRotations) {
  Gltf g = triangleGltf();
  g.add("cameras", "{\"type\":\"perspective\",\"perspective\":{\"yfov\":0.8,\"znear\":0.1}}");
  const std::string child =
      std::to_string(g.add("nodes",
                           "{\"camera\":0,\"rotation\":[0,1,0,0],\"scale\":[0,0,0],\"extensions\":{"
                           "\"KHR_lights_punctual\":{\"light\":0}}}"));
  // A quarter of a turn about x, then half a turn about y.
  g.show("{\"rotation\":[0.70710678,0,0,0.70710678],\"children\":[" + child + "]}");
  g.more =
      ",\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"spot\",\"spot\":{}}]}}";
  const Scene s = load(g);
  EXPECT_LT(length(s.camera.forward - Vec3(0, -1, 0)), 1e-6f);
  EXPECT_LT(length(s.camera.up - Vec3(0, 0, 1)), 1e-6f);
  ASSERT_EQ(s.lights.size(), 1u);
  EXPECT_LT(length(s.lights[0].direction - Vec3(0, -1, 0)), 1e-6f);
}

TEST_F(GltfViews, WhatCannotBeShownAsStatedIsToldOf) {
  Gltf g = triangleGltf();
  g.add("cameras",
        "{\"type\":\"perspective\",\"perspective\":{\"yfov\":0.8,\"aspectRatio\":1000,"
        "\"znear\":0.1}}");
  g.add("cameras",
        "{\"type\":\"orthographic\",\"orthographic\":{\"xmag\":1,\"ymag\":1,"
        "\"zfar\":10,\"znear\":0.1}}");
  g.show("{\"camera\":0}");
  g.show("{\"camera\":1}");
  const Scene s = load(g);
  EXPECT_EQ(s.film.width, kMaxFilmSide);
  EXPECT_EQ(countContaining(s.warnings, "camera #/cameras/0: a film of aspectRatio 1000 is cut"),
            1u)
      << joined(s.warnings);
  EXPECT_EQ(countContaining(s.warnings, "camera #/cameras/1 is orthographic"), 1u);

  const Scene wide = load(
      withLight("{\"type\":\"spot\",\"spot\":{\"innerConeAngle\":0.9,\"outerConeAngle\":0.5}}"));
  EXPECT_EQ(countContaining(wide.warnings, "innerConeAngle exceeds its outerConeAngle"), 1u);
  EXPECT_EQ(wide.lights.at(0).falloffRad, 0.0f);
}

TEST_F(GltfViews, ACameraThatIsNoneOrSeveral) {
  const auto message = [](const std::string& choice, Scene scene) {
    try {
      chooseCamera(choice, scene);
    } catch (const UsageError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  Gltf g = triangleGltf();
  g.add("cameras", "{\"type\":\"perspective\",\"perspective\":{\"yfov\":0.8,\"znear\":0.1}}");
  for (const char* name : {"Door", "Window", "Door"})
    g.show("{\"camera\":0,\"name\":\"" + std::string(name) + "\"}");
  const Scene s = load(g);
  EXPECT_NE(message("Door", s).find("several cameras of this name; choose by number: 0, 2"),
            std::string::npos);
  EXPECT_NE(message("Wall", s).find("no such camera; its cameras have the numbers 0 'Door', 1"),
            std::string::npos);
  EXPECT_EQ(message("Window", s), "");
  EXPECT_EQ(message("2", s), "");
  EXPECT_NE(message("1", load(triangleGltf())).find("its camera has the number 0"),
            std::string::npos);
}

}  // namespace
}  // namespace bnvpl
