// The Cornell box under lights of many kinds and numbers.
#pragma once

#include "core/random.h"
#include "scene/builder/scene_builder.h"
#include "scene/load_scene.h"

namespace bnvpl::test {

inline Scene room(uint32_t width, uint32_t height) {
  Scene scene = loadScene(fs::path(BNVPL_SCENES_DIR) / "cornell/scene.toml");
  scene.film = {width, height};
  return scene;
}

// Gives every corner texture coordinates that differ from those of its neighbours.
inline void addTextureCoordinates(Scene& scene) {
  scene.uvs.clear();
  for (const Vec3 p : scene.positions) scene.uvs.push_back({p.x + 0.31f * p.z, p.y + 0.47f * p.z});
  for (Triangle& t : scene.triangles) t.uv = t.position;
}

// A box open to the viewer, with an area light, a sky with an image, a sun and a point light.
inline Scene manyLights() {
  Scene scene = room(24, 24);
  EnvironmentImage sky;
  sky.width = 16;
  sky.height = 8;
  for (uint32_t i = 0; i < 128; ++i)
    sky.radiance.push_back(Vec3(i / 16 == 3 ? 20.0f : 0.5f + toUnitFloat(random64(1, i, 0))));
  scene.environments.push_back(std::move(sky));
  scene.lights.resize(3);
  scene.lights[0].type = LightType::Environment;
  scene.lights[0].image = 0;
  scene.lights[1].type = LightType::Directional;
  scene.lights[1].direction = normalize(Vec3{0.3f, -0.4f, -1});
  scene.lights[1].angularRadiusRad = 0.03f;
  scene.lights[1].emission = Vec3{20.0f};
  scene.lights[2].position = scene.bounds.center();
  scene.lights[2].emission = Vec3{scene.bounds.diagonal() * scene.bounds.diagonal()} * 0.05f;
  return scene;
}

// The box without its area light: three point lights inside and `hidden` more above its ceiling.
inline Scene bulbs(uint32_t hidden) {
  Scene scene = room(24, 24);
  const Vec3 centre = scene.bounds.center(), extent = scene.bounds.extent();
  for (Material& m : scene.materials) m.emission = {};
  for (uint32_t k = 0; k < 3 + hidden; ++k) {
    LightSpec& s = scene.lights.emplace_back();
    s.position = centre + Vec3{float(k % 3) * 0.2f - 0.2f, 0.2f, 0.2f} * extent;
    if (k >= 3) s.position.y += extent.y * (0.6f + 0.4f * toUnitFloat(random64(3, k, 0)));
    s.emission = Vec3{1.0f};
  }
  return scene;
}

inline void addQuad(SceneBuilder& builder, uint32_t material, Vec3 p, Vec3 a, Vec3 b) {
  std::vector<double> positions;
  for (const Vec3 c : {p, p + a, p + a + b, p + b})
    positions.insert(positions.end(), {double{c.x}, double{c.y}, double{c.z}});
  Mesh mesh{positions, {}, {}, {}};
  for (const auto& corners : {std::array<uint32_t, 3>{0, 1, 2}, {0, 2, 3}})
    mesh.triangles.push_back({corners, kNoCorners, kNoCorners, material});
  builder.addMesh("quads", std::move(mesh));
}

// A room of 4 x 3 x 4 with a window of 2 x 1 on a square of ground, under a sun, whose light falls
// through the window on a sheet of brushed metal. The camera looks at the wall opposite the window,
// away from the sheet: one photon in some 500 enters by
// default.
inline Scene sunnyRoom(float ground = 24.0f) {
  SceneBuilder builder("sunny room");
  builder.setFilm({16, 12});
  Camera camera;
  camera.verticalFovRad = 1.2f;
  camera.forward = {-1, 0, 0}, camera.right = {0, 0, -1};
  builder.setCamera({1.8, 1.5, 0}, camera);
  Material paint, metal;
  paint.model = DiffuseModel{Vec3(0.6f)};
  ConductorModel brushed;
  brushed.roughness = Roughness(0.1f);
  metal.model = brushed;
  const uint32_t wall = builder.addMaterial(paint), sheet = builder.addMaterial(metal);
  const auto quad = [&](uint32_t material, Vec3 p, Vec3 a, Vec3 b) {
    addQuad(builder, material, p, a, b);
  };
  const Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  quad(wall, {-0.5f * ground, -0.01f, -0.5f * ground}, ground * z, ground * x);
  quad(wall, {-2, 0, -2}, 4.0f * z, 4.0f * x);
  quad(sheet, {0, 0.02f, -1}, 2.0f * z, 1.5f * x);
  quad(wall, {-2, 3, -2}, 4.0f * x, 4.0f * z);
  quad(wall, {-2, 0, -2}, 3.0f * y, 4.0f * z);
  quad(wall, {-2, 0, -2}, 4.0f * x, 3.0f * y);
  quad(wall, {-2, 0, 2}, 3.0f * y, 4.0f * x);
  quad(wall, {2, 0, -2}, 4.0f * z, 1.5f * y);  // below, above and beside the window
  quad(wall, {2, 2.5f, -2}, 4.0f * z, 0.5f * y);
  quad(wall, {2, 1.5f, -2}, 1.0f * z, 1.0f * y);
  quad(wall, {2, 1.5f, 1}, 1.0f * z, 1.0f * y);
  LightSpec sun;
  sun.type = LightType::Directional;
  sun.direction = normalize(Vec3{-0.6f, -0.8f, 0.1f});
  sun.angularRadiusRad = 0.02f;
  sun.emission = Vec3(10.0f);
  builder.addLight(sun, {0, 0, 0});
  return builder.finish();
}

// Eight cells in a row, open towards a metal sheet. Each holds a point light behind a cover, so
// that it lights its own cell alone. The camera looks from between at the sheet, or at the covers,
// whose light all comes via the sheet.
inline Scene cellsBeforeMetal(bool seesMetal) {
  constexpr int kCells = 8;
  SceneBuilder builder("cells");
  builder.setFilm({8, 8});  // a single tile sees all cells
  Camera camera;
  camera.verticalFovRad = 1.6f;
  if (seesMetal) camera.forward = {0, 0, 1}, camera.right = {-1, 0, 0};
  builder.setCamera({4, 0.5, seesMetal ? 1.5 : 1.2}, camera);
  Material paint, metal;
  paint.model = DiffuseModel{};
  metal.model = ConductorModel{};
  const uint32_t wall = builder.addMaterial(paint), sheet = builder.addMaterial(metal);
  const auto quad = [&](uint32_t material, Vec3 p, Vec3 a, Vec3 b) {
    addQuad(builder, material, p, a, b);
  };
  quad(sheet, {-4, -4, 3}, {0, 9, 0}, {16, 0, 0});
  quad(wall, {0, 0, 0}, {kCells, 0, 0}, {0, 1, 0});
  quad(wall, {0, 0, 0}, {0, 0, 1}, {kCells, 0, 0});
  quad(wall, {0, 1, 0}, {kCells, 0, 0}, {0, 0, 1});
  for (int k = 0; k <= kCells; ++k) quad(wall, {float(k), 0, 0}, {0, 1, 0}, {0, 0, 1});
  LightSpec bulb;
  bulb.emission = Vec3(1.0f);
  for (int k = 0; k < kCells; ++k) {
    quad(wall, {float(k) + 0.3f, 0.3f, 0.7f}, {0.4f, 0, 0}, {0, 0.4f, 0});
    builder.addLight(bulb, {k + 0.5, 0.5, 0.6});
  }
  return builder.finish();
}

}  // namespace bnvpl::test
