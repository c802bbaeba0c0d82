// What a scene is: plain arrays, ready for ray tracing. load_scene.h reads one from files,
// scene_builder.h makes one in memory.
// Lengths are the scene's own unit (called m below), angles radians in memory, colours linear sRGB.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/errors.h"
#include "core/vec3.h"
#include "scene/material.h"
#include "scene/textures/expression.h"
#include "scene/textures/texture.h"

namespace bnvpl {

inline constexpr uint32_t kMaxFilmSide = 16384;  // pixels, of [film] and --size
struct Film {
  uint32_t width = 640, height = 480;  // pixels
};

// Pinhole. Pixel (0, 0) is the top left one.
struct Camera {
  Vec3 position;
  Vec3 forward{0, 0, -1}, right{1, 0, 0}, up{0, 1, 0};  // orthonormal
  float verticalFovRad = 1.0f;
};

// One corner index triple into each of Scene's arrays. `normal` and `uv` may be kNone.
struct Triangle {
  std::array<uint32_t, 3> position, normal, uv;
  uint32_t material;
};
static_assert(sizeof(Triangle) == 40);

enum class LightType : uint32_t { Point, Spot, Directional, Environment };

// A light that is no surface. Emissive triangles are lights too; LightSet gathers both.
struct LightSpec {
  LightType type = LightType::Point;
  Vec3 position;             // point, spot
  Vec3 direction{0, 0, -1};  // spot, directional: the way the light travels
  Vec3 emission;            // intensity W/sr; irradiance W/m2 (directional); radiance (environment)
  float coneRad = 0.0f;     // spot: half angle outside which it is dark
  float falloffRad = 0.0f;  // spot: width of the soft rim inside the cone
  float angularRadiusRad = 0.0f;  // directional: half the angular diameter
  uint32_t image = kNone;         // environment: into Scene::environments
  float rotateRad = 0.0f;         // environment: about +y
  float scale = 1.0f;             // environment
};

// Of a scene, problem and cure.
inline constexpr const char* kNoLight =
    "has no light with power: its images are black; add a [[light]] or an emissive material (Ke)";

struct Scene {
  Film film;
  Camera camera;

  std::vector<Vec3> positions;  // one more than indexed: Embree reads 16 bytes at each vertex
  std::vector<Vec3> normals;    // unit length
  std::vector<std::array<float, 2>> uvs;
  std::vector<Triangle> triangles;  // opaque ones first
  uint32_t maskedBegin = 0;         // first triangle whose material has an alpha mask
  Bounds bounds;
  // What the coordinates count from, in the coordinates of the files: 0 but for scenes that lie far
  // from their own origin, which floats would resolve coarsely there (sceneOrigin in affine.h).
  std::array<double, 3> origin{};

  std::vector<Material> materials;
  std::vector<Texture> textures;
  std::vector<TextureExpression> expressions;
  std::vector<LightSpec> lights;
  std::vector<EnvironmentImage> environments;

  uint64_t contentHash = 0;     // of geometry, materials, textures and lights; not of the camera
  std::vector<fs::path> files;  // everything that was read, for depfiles
  std::vector<std::string> warnings;  // each names what was ignored or repaired

  // Whether anything shines: a light that is not black, or a triangle whose material emits.
  bool hasLight() const;
  // Throws InputError, naming the scene, when nothing does.
  void requireLight() const;

  std::string name() const {  // for messages
    return files.empty() ? "the scene" : files.front().string();
  }
  // What an expression is at finite texture coordinates.
  Vec3 expressionAt(uint32_t expression, float u, float v) const {
    return TextureEvaluator(expressions, textures).at(expression, u, v);
  }
  // Radiance of a material, at texture coordinates that may be NaN.
  Vec3 emissionAt(const Material& m, float u, float v) const {
    if (m.emissionTexture == kNone || !std::isfinite(u) || !std::isfinite(v)) return m.emission;
    return m.emission * expressionAt(m.emissionTexture, u, v);
  }
  Vec3 corner(uint32_t triangle, size_t i) const {
    return positions[triangles[triangle].position[i]];
  }
};

}  // namespace bnvpl
