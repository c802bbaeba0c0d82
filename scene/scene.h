// A scene as plain arrays, ready for ray tracing. load_scene.h reads one from files,
// scene_builder.h builds one in memory.
// Lengths are in the scene's own unit (called m below), angles in radians, colours in linear sRGB.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/errors.h"
#include "core/vec3.h"
#include "scene/filter_spec.h"
#include "scene/material.h"
#include "scene/textures/expression.h"
#include "scene/textures/texture.h"

namespace bnvpl {

inline constexpr uint32_t kMaxFilmSide = 16384;  // pixels; limit of [film] and --size
struct Film {
  uint32_t width = 640, height = 480;  // pixels
  // Whether camera rays that leave the scene at once carry no light, for compositing.
  bool transparent = false;
  FilterSpec filter = {};  // pixel filter of images; VPLs do not depend on it
};

// Limits of a lens, with which rays through it stay within floats.
inline constexpr double kMaxLensLength = 1e9, kMinFocusDistance = 1e-9;

// A pinhole or a thin lens. Pixel (0, 0) is at the top left. The film's centre lies `shift` film
// heights to the right of the viewing axis and above it, for crops and shifted lenses.
struct Camera {
  Vec3 position;
  Vec3 forward{0, 0, -1}, right{1, 0, 0}, up{0, 1, 0};  // orthonormal
  float verticalFovRad = 1.0f;                          // field of view of the unshifted film
  std::array<float, 2> shift{};
  float lensRadius = 0.0f;     // 0: a pinhole, which sees everything sharp
  float focusDistance = 1.0f;  // along the viewing axis, of the plane that the lens sees sharp; > 0
  bool hasLens() const { return lensRadius > 0.0f; }
  // Whether the image is mirrored left to right, as by pbrt's cameras: its space is left-handed.
  bool isMirrored() const { return dot(cross(forward, up), right) < 0.0f; }
};

// A camera of the scene file and its film.
struct View {
  std::string name;  // empty if the file gives none
  Camera camera;
  Film film;
};

// Indices of the three corners in Scene's arrays. `normal` and `uv` may be kNone.
struct Triangle {
  std::array<uint32_t, 3> position, normal, uv;
  uint32_t material;
};
static_assert(sizeof(Triangle) == 40);

// Triangles that occur many times, stored once in coordinates of their own. None of them emits:
// emissive triangles are stored in the world, once for each instance.
struct Prototype {
  uint32_t begin = 0, maskedBegin = 0, end = 0;  // range of Scene::triangles, opaque ones first
};

// An occurrence of a prototype.
struct Instance {
  uint32_t prototype = 0;
  uint32_t mirrored = 0;                 // 1 if the transform mirrors, which flips windings
  std::array<float, 12> toWorld{};       // rows of a 3x4 matrix, applied to column vectors
  std::array<float, 9> normalToWorld{};  // rows of its inverse transpose up to a positive factor
  Vec3 point(Vec3 p) const {
    const auto row = [&](size_t r) {
      return toWorld[4 * r] * p.x + toWorld[4 * r + 1] * p.y + toWorld[4 * r + 2] * p.z +
             toWorld[4 * r + 3];
    };
    return {row(0), row(1), row(2)};
  }
  Vec3 normal(Vec3 n) const {  // not normalised
    const auto row = [&](size_t r) {
      return normalToWorld[3 * r] * n.x + normalToWorld[3 * r + 1] * n.y +
             normalToWorld[3 * r + 2] * n.z;
    };
    return {row(0), row(1), row(2)};
  }
  // The box around the transformed corners of a box.
  Bounds box(const Bounds& own) const {
    Bounds out;
    for (int k = 0; k < 8; ++k) {
      out.extend(point({k & 1 ? own.upper.x : own.lower.x, k & 2 ? own.upper.y : own.lower.y,
                        k & 4 ? own.upper.z : own.lower.z}));
    }
    return out;
  }
  // Transforms a vector in the surface, such as a tangent.
  Vec3 vector(Vec3 v) const {
    const auto row = [&](size_t r) {
      return toWorld[4 * r] * v.x + toWorld[4 * r + 1] * v.y + toWorld[4 * r + 2] * v.z;
    };
    return {row(0), row(1), row(2)};
  }
};

// A triangle and the index of its object in Scene::objectNames.
struct ObjectTriangle {
  Triangle triangle;
  uint32_t object;
};

// The triangles from `firstTriangle` up to the next run are part of one object.
struct ObjectRun {
  uint32_t firstTriangle, object;
};

enum class LightType : uint32_t { Point, Spot, Directional, Environment };

// Maximal number of light groups, that of lights without a group included.
inline constexpr size_t kMaxLightGroups = 32;

// A light that is not a surface. LightSet combines these with the emissive triangles.
struct LightSpec {
  LightType type = LightType::Point;
  std::string name;          // empty if the file gives none
  Vec3 position;             // point, spot
  Vec3 direction{0, 0, -1};  // spot, directional: direction of propagation
  Vec3 emission;            // intensity W/sr; irradiance W/m2 (directional); radiance (environment)
  float coneRad = 0.0f;     // spot: half angle outside which it is dark
  float falloffRad = 0.0f;  // spot: width of the soft rim inside the cone
  float angularRadiusRad = 0.0f;  // directional: half the angular diameter
  uint32_t image = kNone;         // environment: into Scene::environments
  float rotateRad = 0.0f;         // environment: rotation about +y
  float scale = 1.0f;             // environment: factor on the radiance
  uint32_t group = 0;             // into Scene::lightGroups

  // Whether it shines from one point of the scene.
  bool pointOrSpot() const { return type == LightType::Point || type == LightType::Spot; }
};

// A mesh by its name in the files. Its counts include triangles that are left out later.
struct MeshRecord {
  std::string name;
  size_t triangles = 0, instances = 0;  // `triangles` counts one instance
};

// Receives each warning: a text that names what was ignored or repaired.
using OnWarning = std::function<void(const std::string&)>;

struct Scene {
  Film film;
  Camera camera;
  // All cameras of the file. `film` and `camera` are those of the first unless choose_view.h
  // selects another.
  std::vector<View> views;

  std::vector<Vec3> positions;  // padded by one: Embree reads 16 bytes at each vertex
  std::vector<Vec3> normals;    // unit length
  std::vector<std::array<float, 2>> uvs;
  // Triangles of the world, opaque ones first, followed by those of the prototypes.
  std::vector<Triangle> triangles;
  uint32_t maskedBegin = 0;  // first world triangle whose material has an alpha mask
  uint32_t worldEnd() const {
    return prototypes.empty() ? static_cast<uint32_t>(triangles.size()) : prototypes.front().begin;
  }
  // Number of stored triangles with an alpha mask; those of a prototype count once.
  size_t maskedTriangles() const {
    size_t count = worldEnd() - maskedBegin;
    for (const Prototype& p : prototypes) count += p.end - p.maskedBegin;
    return count;
  }
  // Triangles that reach far away, as the files have them. `triangles` has the pieces into which
  // they are cut, each of which has a vertex among the positions that the cuts have made.
  std::vector<ObjectTriangle> cutFaces;
  uint32_t cutsBegin = 0, cutsEnd = 0;  // range of those positions
  bool isPiece(const Triangle& t) const {
    return std::ranges::any_of(t.position,
                               [&](uint32_t p) { return p >= cutsBegin && p < cutsEnd; });
  }
  std::vector<Prototype> prototypes;
  std::vector<Instance> instances;
  Bounds bounds;  // box around all triangles but strays (scene/strays.h)
  // Diagonal of the box around triangles that lie near the others; scales ray-origin offsets.
  float nearSize = INFINITY;
  float offsetSize() const { return std::min(nearSize, bounds.diagonal()); }
  // Least distance by which ray origins are moved off their surfaces. rayOffset() adds what floats
  // of the magnitude of the largest coordinate need.
  float minRayOffset() const { return offsetSize() * 0x1p-20f; }
  static float rayOffset(float magnitude, float min) { return magnitude * 0x1p-18f + min; }
  // Origin of the scene's coordinates, in those of the files. It is 0 unless the scene lies so far
  // from 0 that floats would resolve it coarsely (sceneOrigin in affine.h).
  std::array<double, 3> origin{};

  // Objects are the things that a scene file names: an `o` of an OBJ, a node of glTF, a shape or
  // object of pbrt. Names are unique, each is one line, and each object has a triangle.
  std::vector<std::string> objectNames;
  std::vector<ObjectRun> objectRuns;      // ascending; the first begins at triangle 0
  std::vector<uint32_t> instanceObjects;  // one for each instance; kNone: as its triangles
  // Index into objectNames of what a ray hit: SurfacePoint::triangle and SurfacePoint::instance.
  // Its cost is a binary search in objectRuns.
  uint32_t objectOf(uint32_t triangle, uint32_t instance = kNone) const;

  std::vector<MeshRecord> meshes;  // for reports
  std::vector<Material> materials;
  std::vector<Texture> textures;
  std::vector<TextureExpression> expressions;
  std::vector<LightSpec> lights;
  std::vector<EnvironmentImage> environments;
  // Light groups, whose light images can show apart: first that of lights without a group, then the
  // others by name.
  std::vector<std::string> lightGroups{"default"};
  // Number of light groups; 0 if no light has one.
  uint32_t lightGroupCount() const {
    return lightGroups.size() > 1 ? static_cast<uint32_t>(lightGroups.size()) : 0;
  }

  uint64_t contentHash = 0;     // covers geometry, materials, textures and lights, not the camera
  std::vector<fs::path> files;  // every file that was read or is missing, for depfiles
  std::vector<std::string> warnings;  // each names what was ignored or repaired

  // Whether anything emits: a light that is not black, or a triangle with an emissive material.
  bool hasLight() const;
  // Message about a scene without light: its name, the problem and a remedy.
  std::string noLight() const;
  // Throws InputError with noLight() if nothing emits.
  void requireLight() const;
  // Whether the scene file is a scene.toml, to which lights can be added.
  bool isToml() const;

  std::string name() const {  // for messages
    return files.empty() ? "the scene" : files.front().string();
  }
  // Value of an expression at finite texture coordinates.
  Vec3 expressionAt(uint32_t expression, float u, float v) const {
    return TextureEvaluator(expressions, textures).at(expression, u, v);
  }
  // Emitted radiance of a material. The texture counts as 1 where u or v is not finite.
  Vec3 emissionAt(const Material& m, float u, float v) const {
    if (m.emissionTexture == kNone || !std::isfinite(u) || !std::isfinite(v)) return m.emission;
    return m.emission * expressionAt(m.emissionTexture, u, v);
  }
  Vec3 corner(uint32_t triangle, size_t i) const {
    return positions[triangles[triangle].position[i]];
  }
  // The box around a prototype, in its own coordinates.
  Bounds boxOf(const Prototype& p) const {
    Bounds box;
    for (uint32_t t = p.begin; t < p.end; ++t) {
      for (size_t i = 0; i < 3; ++i) box.extend(corner(t, i));
    }
    return box;
  }
};

}  // namespace bnvpl
