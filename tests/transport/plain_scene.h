// Scenes made in memory for tests of materials and lights, and averages over many draws.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "core/random.h"
#include "core/random_streams.h"
#include "core/sampling.h"
#include "transport/bsdf.h"
#include "transport/lights/lights.h"

namespace bnvpl {

// Adds a square of two triangles: a corner and two sides whose cross product is the lit side.
inline void addSquare(Scene& scene, Vec3 corner, Vec3 a, Vec3 b, const Material& material) {
  const auto first = static_cast<uint32_t>(scene.positions.size());
  for (const Vec3 p : {corner, corner + a, corner + a + b, corner + b})
    scene.positions.push_back(p);
  scene.materials.push_back(material);
  const auto m = static_cast<uint32_t>(scene.materials.size() - 1);
  const std::array<uint32_t, 3> none{kNone, kNone, kNone};
  scene.triangles.push_back({{first, first + 1, first + 2}, none, none, m});
  scene.triangles.push_back({{first, first + 2, first + 3}, none, none, m});
}

// Sets bounds and padding as loading does. No square may follow.
inline void finishScene(Scene& scene) {
  scene.maskedBegin = static_cast<uint32_t>(scene.triangles.size());
  for (const Vec3 p : scene.positions) scene.bounds.extend(p);
  scene.positions.push_back({});
}

inline Material lambert(Vec3 kd) {
  Material m;
  m.name = "lambert";
  m.phong().diffuse = kd;
  return m;
}
inline Material lamp(Vec3 radiance, bool twoSided = false) {
  Material m;
  m.name = "lamp";
  m.emission = radiance;
  m.twoSidedEmission = twoSided;
  return m;
}

// A floor of 4 x 6 and a small dark shelf 3 above it, which gives the scene a height and so a box
// for light from infinity. The floor is material 0 and faces +y.
inline Scene floorScene() {
  Scene scene;
  addSquare(scene, {-2, 0, 3}, {4, 0, 0}, {0, 0, -6}, lambert(Vec3(0.5f)));
  addSquare(scene, {-2, 3, -3}, {0.01f, 0, 0}, {0, 0, 0.01f}, lambert(Vec3(0.0f)));
  finishScene(scene);
  return scene;
}

// The mean of `term(rng)` over `count` draws, each with its own random numbers.
inline Vec3 meanOver(int count, const std::function<Vec3(Rng&)>& term) {
  double sum[3] = {0, 0, 0};
  for (int i = 0; i < count; ++i) {
    Rng rng(streamKey(42, RandomStream::PixelSamples), uint64_t(i));
    const Vec3 v = term(rng);
    for (size_t c = 0; c < 3; ++c) sum[c] += double{v[c]};
  }
  return {float(sum[0] / count), float(sum[1] / count), float(sum[2] / count)};
}

// Relative comparison of all channels.
inline void expectClose(Vec3 actual, Vec3 expected, float relative, const std::string& what = "") {
  for (size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(actual[c], expected[c], relative * std::fabs(expected[c]) + 1e-7f)
        << what << " channel " << c;
  }
}

// A surface point with the given normals, seen from the direction wo.
inline SurfacePoint pointSeenFrom(Vec3 wo, Vec3 ng = {0, 0, 1}, Vec3 ns = {0, 0, 1},
                                  bool front = true) {
  SurfacePoint p;
  p.wo = normalize(wo);
  p.ng = ng;
  p.ns = normalize(ns);
  p.u = p.v = NAN;
  p.material = 0;
  p.triangle = 0;
  p.front = front;
  return p;
}
inline Scene sceneOf(const Material& m) {
  Scene scene;
  scene.materials.push_back(m);
  return scene;
}

// A floor seen from above, a wall and a lamp. More may be added before finishScene().
inline Scene floorAndWallBelowLamp(Film film) {
  Scene scene;
  addSquare(scene, {-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, lambert(Vec3(0.5f)));
  addSquare(scene, {-2, 0, -2}, {4, 0, 0}, {0, 3, 0}, lambert(Vec3(0.8f)));
  addSquare(scene, {-0.5f, 2.9f, 0.5f}, {0, 0, -1}, {1, 0, 0}, lamp(Vec3(10)));
  scene.film = film;
  scene.camera.position = {0, 2, 0.3f};
  scene.camera.forward = {0, -1, 0};
  scene.camera.right = {1, 0, 0};
  scene.camera.up = {0, 0, -1};
  scene.camera.verticalFovRad = 0.6f;
  return scene;
}

}  // namespace bnvpl
