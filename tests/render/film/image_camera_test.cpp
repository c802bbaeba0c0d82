// The camera in the header of an image is the one that rays come from.
#include "tools/render/image_camera.h"

#include <gtest/gtest.h>

#include "tests/render/lit_rooms.h"
#include "transport/camera.h"

namespace bnvpl {
namespace {

// (x, y, z, 1) M
std::array<double, 4> times(const std::array<double, 3>& p, const std::array<float, 16>& m) {
  std::array<double, 4> out{};
  for (size_t j = 0; j < 4; ++j)
    out[j] =
        p[0] * double{m[j]} + p[1] * double{m[4 + j]} + p[2] * double{m[8 + j]} + double{m[12 + j]};
  return out;
}

Scene shiftedScene() {
  Scene scene = test::room(120, 80);
  scene.camera.shift = {0.3f, -0.2f};
  scene.origin = {100.0, -20.0, 3.0};
  return scene;
}

TEST(ImageCamera, ProjectsPointsToTheFilm) {
  const Scene scene = shiftedScene();
  const ImageCamera camera = imageCameraOf(scene);
  for (uint64_t i = 0; i < 100; ++i) {
    Rng rng(7, i);
    const float x = rng.next(), y = rng.next(), distance = 0.2f + rng.next();
    const Vec3 direction = cameraDirection(scene.camera, scene.film, x, y);
    const Vec3 p = scene.camera.position + direction * distance;
    const std::array<double, 3> world{double{p.x} + 100.0, double{p.y} - 20.0, double{p.z} + 3.0};
    const auto ndc = times(world, camera.worldToNdc);
    EXPECT_NEAR(ndc[0] / ndc[3], double{x}, 2e-4);
    EXPECT_NEAR(ndc[1] / ndc[3], double{y}, 2e-4);
    const auto seen = times(world, camera.worldToCamera);
    EXPECT_NEAR(seen[2], double{dot(p - scene.camera.position, scene.camera.forward)}, 2e-5);
    EXPECT_NEAR(seen[3], 1.0, 1e-9);
    // The screen window is the film at distance 1, with y up.
    const double height = double{camera.screenWindowWidth} * 80.0 / 120.0;
    EXPECT_NEAR(
        seen[0] / seen[2],
        double{camera.screenWindowCenter[0]} + (double{x} - 0.5) * double{camera.screenWindowWidth},
        2e-4);
    EXPECT_NEAR(seen[1] / seen[2],
                double{camera.screenWindowCenter[1]} + (0.5 - double{y}) * height, 2e-4);
  }
}

TEST(ImageCamera, SurvivesJson) {
  const ImageCamera camera = imageCameraOf(shiftedScene());
  EXPECT_EQ(imageCameraOf(Json::parse(toJson(camera).dump())), camera);
  EXPECT_THROW(imageCameraOf(Json{{"numbers", std::vector<float>(34)}}), InputError);
}

}  // namespace
}  // namespace bnvpl
