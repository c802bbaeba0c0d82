// Normal maps and bump maps: the shading normals that rays report.
#include "tests/transport/plain_scene.h"
#include "transport/bump_mapping.h"

namespace bnvpl {
namespace {

// A unit square in the plane z = 0 that faces +z, with u along x (or mirrored) and v along y.
Scene square(const Material& m, bool mirroredU = false) {
  Scene scene;
  addSquare(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, m);
  for (const Vec3 p : scene.positions) scene.uvs.push_back({mirroredU ? 1 - p.x : p.x, p.y});
  for (Triangle& t : scene.triangles) t.uv = t.position;
  addSquare(scene, {0, 0, -9}, {0.1f, 0, 0}, {0, 0.1f, 0}, lambert(Vec3(0)));
  finishScene(scene);
  return scene;
}
Material mapped(uint32_t Relief::*map, float strength = 1.0f) {
  Material m;
  m.model = DiffuseModel{};
  m.relief.*map = 0;
  m.relief.strength = strength;
  return m;
}
SurfacePoint hitFrom(const Scene& scene, Vec3 from) {
  const Accelerator accel(scene);
  SurfacePoint hit;
  const Vec3 to{0.3f, 0.6f, 0};
  EXPECT_TRUE(accel.closestHit(from, normalize(to - from), hit));
  EXPECT_EQ(hit.material, 0u);
  return hit;
}
void expectNear(Vec3 a, Vec3 b) {
  EXPECT_LT(length(a - b), 2e-3f) << a.x << " " << a.y << " " << a.z;
}

constexpr Vec3 kTilt{0.6f, 0.0f, 0.8f};
TextureExpression colourOf(Vec3 normal) { return constantExpression(0.5f * normal + Vec3(0.5f)); }

TEST(Relief, NormalMapIsInTheFrameOfTheTextureCoordinates) {
  Scene scene = square(mapped(&Relief::normalMap));
  scene.expressions.push_back(colourOf(kTilt));
  expectNear(hitFrom(scene, {0.3f, 0.6f, 2}).ns, kTilt);
  expectNear(hitFrom(scene, {0.3f, 0.6f, 2}).tangent, {1, 0, 0});
  scene.expressions[0] = colourOf({0, 0.6f, 0.8f});
  expectNear(hitFrom(scene, {0.3f, 0.6f, 2}).ns, {0, 0.6f, 0.8f});
  Scene mirrored = square(mapped(&Relief::normalMap), true);
  mirrored.expressions.push_back(colourOf(normalize({0.5f, 0.5f, 1})));
  expectNear(hitFrom(mirrored, {0.3f, 0.6f, 2}).ns, normalize({-0.5f, 0.5f, 1}));
}

TEST(Relief, FlatMapChangesNothing) {
  for (uint32_t Relief::*const map : {&Relief::normalMap, &Relief::bumpMap}) {
    Scene scene = square(mapped(map));
    scene.expressions.push_back(colourOf({0, 0, 1}));
    expectNear(hitFrom(scene, {0.3f, 0.6f, 2}).ns, {0, 0, 1});
    expectNear(hitFrom(scene, {0.3f, 0.6f, -2}).ns, {0, 0, -1});
  }
}

// A bump of the front is a dent of the back: the normal is the same, seen from either side.
TEST(Relief, BackShowsTheSameRelief) {
  Scene scene = square(mapped(&Relief::normalMap));
  scene.expressions.push_back(colourOf(kTilt));
  const SurfacePoint back = hitFrom(scene, {0.3f, 0.6f, -2});
  expectNear(back.ns, -kTilt);
  expectNear(back.ng, {0, 0, -1});
}

// In glTF, a clearcoat has its own normal map and is smooth without one.
TEST(Relief, CoatHasItsOwn) {
  Material m = mapped(&Relief::normalMap);
  Scene scene = square(m);
  scene.expressions = {colourOf(kTilt), colourOf({0, 0.6f, 0.8f})};
  expectNear(hitFrom(scene, {0.3f, 0.6f, 2}).coat, {0, 0, 1});
  m.coatRelief.normalMap = 1;
  scene.materials[0] = m;
  expectNear(hitFrom(scene, {0.3f, 0.6f, 2}).coat, {0, 0.6f, 0.8f});
  expectNear(hitFrom(scene, {0.3f, 0.6f, -2}).coat, {0, -0.6f, -0.8f});
  m.relief = {};
  scene.materials[0] = m;
  expectNear(hitFrom(scene, {0.3f, 0.6f, 2}).coat, {0, 0.6f, 0.8f});
  expectNear(hitFrom(scene, {0.3f, 0.6f, 2}).ns, {0, 0, 1});
  m.coatRelief = {};
  scene.materials[0] = m;
  expectNear(hitFrom(scene, {0.3f, 0.6f, 2}).coat, {});
}

TEST(Relief, StaysAboveTheSurface) {
  Scene scene = square(mapped(&Relief::normalMap, 1000.0f));
  scene.expressions.push_back(colourOf({1, 0, -1}));
  const SurfacePoint hit = hitFrom(scene, {0.3f, 0.6f, 2});
  EXPECT_GE(dot(hit.ns, hit.ng), 0.9f * kMinShadingCosine);
  EXPECT_NEAR(length(hit.ns), 1.0f, 1e-5f);
  EXPECT_GT(hit.ns.x, 0.9f);
}

// A ramp of slope 1/2 along u, from a texture of 64 texels that rises from 0 to 1.
TEST(Relief, BumpMapTiltsByItsSlope) {
  for (const bool mirroredU : {false, true}) {
    Scene scene = square(mapped(&Relief::bumpMap, 0.5f), mirroredU);
    Texture ramp;
    ramp.width = 64, ramp.height = 1;
    ramp.srgb = false;
    for (int i = 0; i < 64; ++i) {
      const auto value = uint8_t(i * 4);
      ramp.rgba.insert(ramp.rgba.end(), {value, value, value, 255});
    }
    scene.textures.push_back(ramp);
    scene.expressions.push_back(imageExpression(0));
    const float slope = 0.5f * 4 * 64 / 255 * (mirroredU ? -1.0f : 1.0f);
    expectNear(hitFrom(scene, {0.3f, 0.6f, 2}).ns, normalize({-slope, 0, 1}));
    expectNear(hitFrom(scene, {0.3f, 0.6f, -2}).ns, -normalize({-slope, 0, 1}));
  }
}

// A height in texels rises over one texel in each direction, whatever the image is stretched to.
TEST(Relief, HeightsInTexelsFollowTheTexelsOfEachDirection) {
  for (const std::array<float, 2> scale : {std::array{1.0f, 1.0f}, {4.0f, 1.0f}, {1.0f, 8.0f}}) {
    Material m = mapped(&Relief::bumpMap, 5.0f);
    m.relief.heightInTexels = true;
    Scene scene = square(m);
    Texture ramp;
    ramp.width = 64, ramp.height = 16;
    ramp.srgb = false;
    ramp.scale = scale;
    for (int row = 0; row < 16; ++row) {
      for (int column = 0; column < 64; ++column) {
        const auto value = uint8_t(2 * column + 4 * (15 - row));
        ramp.rgba.insert(ramp.rgba.end(), {value, value, value, 255});
      }
    }
    scene.textures.push_back(ramp);
    scene.expressions.push_back(imageExpression(0));
    expectNear(hitFrom(scene, {0.3f, 0.6f, 2}).ns,
               normalize({-5.0f * 2 / 255, -5.0f * 4 / 255, 1}));
  }
}

// The opacity texture has its own cutoff.
TEST(Relief, OpacityTextureCutsAway) {
  for (const float cutoff : {0.2f, 0.4f}) {
    Material m;
    m.opacityTexture = 0;
    m.opacityCutoff = cutoff;
    Scene scene = square(m);
    scene.expressions.push_back(constantExpression(Vec3(0.3f)));
    scene.maskedBegin = 0;
    const Accelerator accel(scene);
    SurfacePoint hit;
    EXPECT_EQ(accel.closestHit({0.3f, 0.6f, 2}, {0, 0, -1}, hit), cutoff < 0.3f);
  }
}

}  // namespace
}  // namespace bnvpl
