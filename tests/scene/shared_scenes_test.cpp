// Real models, where available: in BNVPL_SHARED_SCENES, else in shared/scenes beside the project.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include "scene/load_scene.h"
#include "transport/lights/lights.h"

namespace bnvpl {
namespace {

fs::path sharedScenes() {
  const char* folder = std::getenv("BNVPL_SHARED_SCENES");
  return folder ? folder : BNVPL_SHARED_SCENES;
}

#define SKIP_WITHOUT(file)                                                                        \
  if (!fs::exists(sharedScenes() / (file))) {                                                     \
    GTEST_SKIP() << (sharedScenes() / (file)).lexically_normal()                                  \
                 << " is not there; set BNVPL_SHARED_SCENES to the folder that holds the models"; \
  }

size_t warningsWith(const Scene& scene, const std::string& part) {
  return size_t(
      std::count_if(scene.warnings.begin(), scene.warnings.end(),
                    [&](const std::string& w) { return w.find(part) != std::string::npos; }));
}
void expectBounds(const Scene& scene, Vec3 lower, Vec3 upper, float tolerance) {
  EXPECT_LT(length(scene.bounds.lower - lower), tolerance);
  EXPECT_LT(length(scene.bounds.upper - upper), tolerance);
}

// Loads the OBJ with its own library and an arbitrary camera.
Scene loadObj(const fs::path& obj) {
  const fs::path toml =
      fs::temp_directory_path() / ("bnvpl-shared-" + std::to_string(::getpid()) + ".toml");
  std::ofstream(toml) << "[film]\nwidth = 8\nheight = 8\n[camera]\nposition = [0.0, 0.0, 4.0]\n"
                         "look_at = [0.0, 0.0, 0.0]\nvertical_fov_deg = 40.0\n"
                         "[[mesh]]\nfile = \""
                      << fs::absolute(obj).string() << "\"\n";
  const Scene scene = loadScene(toml);
  fs::remove(toml);
  return scene;
}

TEST(SharedScenes, Sponza) {
  SKIP_WITHOUT("sponza/sponza.obj");
  const Scene scene = loadObj(sharedScenes() / "sponza/sponza.obj");
  EXPECT_EQ(scene.triangles.size(), 262137u);
  expectBounds(scene, {-1921, -126, -1183}, {1800, 1429, 1105}, 3.0f);
  EXPECT_GT(scene.maskedTriangles(), 10000u);  // leaves, plants and chains
  EXPECT_GT(scene.textures.size(), 15u);
  EXPECT_EQ(warningsWith(scene, "no such texture"), 0u);
  size_t bumpy = 0;
  for (const Material& m : scene.materials) bumpy += m.relief.bumpMap != kNone;
  EXPECT_EQ(bumpy, 10u);
}

TEST(SharedScenes, SponzaByTheScenesOfTheProject) {
  SKIP_WITHOUT("sponza/sponza.obj");
  for (const char* view : {"sponza/scene.toml", "sponza/gallery.toml"}) {
    const Scene scene = loadScene(fs::path(BNVPL_SCENES) / view,
                                  {{"SPONZA_DIR", (sharedScenes() / "sponza").string()}});
    EXPECT_EQ(scene.triangles.size(), 262137u) << view;
    EXPECT_EQ(warningsWith(scene, "no such texture"), 0u) << view;
    EXPECT_FALSE(scene.lights.empty()) << view;
  }
}

TEST(SharedScenes, VeachAjar) {
  SKIP_WITHOUT("veach-ajar/veach-ajar.obj");
  const Scene scene = loadScene(fs::path(BNVPL_SCENES) / "veach-ajar/scene.toml",
                                {{"VEACH_AJAR_DIR", (sharedScenes() / "veach-ajar").string()}});
  EXPECT_EQ(scene.triangles.size(),
            382690u - 62u);  // as in the file, except those without an area
  EXPECT_EQ(warningsWith(scene, "62 triangles without area"), 1u);
  expectBounds(scene, {-9.6f, 0, -7.6f}, {7.4f, 3.8f, 0.6f}, 0.2f);
  const Accelerator accel(scene);
  const LightSet lights(accel);
  ASSERT_EQ(lights.size(), 1u);
  EXPECT_NE(lights.name(0).find("Light_emit"), std::string::npos);
  const float area = lights.power(0).x / (1000.0f * 3.14159265f);  // one-sided, radiance 1000
  EXPECT_NEAR(area, 3.86f, 0.01f);
  EXPECT_EQ(std::count_if(scene.materials.begin(), scene.materials.end(),
                          [](const Material& m) { return m.phong().glass; }),
            1);
  // The winding of the area light faces -z, into the room.
  size_t shining = 0;
  for (uint32_t t = 0; t < scene.triangles.size(); ++t) {
    if (isBlack(scene.materials[scene.triangles[t].material].emission)) continue;
    const Vec3 n = normalize(
        cross(scene.corner(t, 1) - scene.corner(t, 0), scene.corner(t, 2) - scene.corner(t, 0)));
    EXPECT_LT(n.z, -0.99f);
    ++shining;
  }
  EXPECT_GT(shining, 0u);
}

TEST(SharedScenes, CornellBox) {
  SKIP_WITHOUT("cornell-box");
  fs::path obj;
  for (const auto& entry : fs::directory_iterator(sharedScenes() / "cornell-box")) {
    if (entry.path().extension() == ".obj") obj = entry.path();
  }
  ASSERT_FALSE(obj.empty());
  const Scene scene = loadObj(obj);
  EXPECT_EQ(scene.triangles.size(), 36u);
  expectBounds(scene, {-1.02f, 0, -1.04f}, {1, 1.99f, 0.99f}, 0.02f);
  EXPECT_TRUE(scene.normals.empty());
  const Accelerator accel(scene);
  const LightSet lights(accel);
  ASSERT_EQ(lights.size(), 1u);
  EXPECT_NEAR(lights.power(0).x / lights.power(0).z, 17.0f / 4.0f, 1e-4f);
  // The area light faces down into the box: a ray from below sees its emission.
  SurfacePoint hit;
  ASSERT_TRUE(accel.closestHit({-0.005f, 1.0f, -0.03f}, {0, 1, 0}, hit));
  size_t light = kNone;
  EXPECT_EQ(lights.emitted(hit, light), Vec3(17, 12, 4));
}

// Loads a pbrt scene and expects that it holds nothing unknown.
Scene loadPbrt(const std::string& name) {
  Scene scene = loadScene(sharedScenes() / "pbrt" / name);
  EXPECT_EQ(warningsWith(scene, "unknown"), 0u);
  EXPECT_EQ(warningsWith(scene, "no such"), 0u);
  EXPECT_TRUE(scene.hasLight());
  return scene;
}

TEST(SharedScenes, PbrtLivingRoom) {
  SKIP_WITHOUT("pbrt/living-room/living-room.pbrt");
  const Scene scene = loadPbrt("living-room/living-room.pbrt");
  EXPECT_EQ(scene.triangles.size(), 142973u);
  EXPECT_LT(length(scene.camera.position - Vec3(5.10518f, 0.731066f, -2.31789f)), 1e-4f);
  // The camera is right-handed because its transform mirrors.
  EXPECT_LT(length(cross(scene.camera.forward, scene.camera.up) - scene.camera.right), 1e-4f);
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.environments.size(), 1u);
  EXPECT_EQ(scene.textures.size(), 4u);
}

TEST(SharedScenes, PbrtBathroom) {
  SKIP_WITHOUT("pbrt/bathroom/bathroom.pbrt");
  const Scene scene = loadPbrt("bathroom/bathroom.pbrt");
  EXPECT_EQ(scene.triangles.size(), 591906u);
  EXPECT_EQ(scene.film.width, 1024u);
  EXPECT_EQ(scene.textures.size(), 10u);
  EXPECT_GT(scene.maskedTriangles(), 0u);  // the rug
}

TEST(SharedScenes, PbrtOthers) {
  SKIP_WITHOUT("pbrt/veach-mis/veach-mis.pbrt");
  const Scene mis = loadPbrt("veach-mis/veach-mis.pbrt");
  EXPECT_EQ(mis.materials.size(), 10u);  // five area lights, four plates, a floor
  EXPECT_EQ(loadPbrt("veach-ajar/veach-ajar.pbrt").triangles.size(), 382628u);
  EXPECT_EQ(loadPbrt("material-testball/material-testball.pbrt").triangles.size(), 80642u);
}

}  // namespace
}  // namespace bnvpl
