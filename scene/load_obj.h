// OBJ and MTL files -> triangles, materials and textures of a Scene.
#pragma once

#include <array>
#include <map>
#include <set>
#include <string>

#include "scene/scene.h"

namespace bnvpl {

// A place or direction as the files give it, before anything is rounded to floats.
using Point = std::array<double, 3>;

// Row-major 3x4 matrix, applied to column vectors.
struct Affine {
  std::array<std::array<double, 4>, 3> m{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

  Point point(const Point& p) const;
  Vec3 normal(const Point& n) const;  // by the inverse transpose; unit length, or 0
  double determinant() const;         // negative: mirrors, so that windings must turn
  // Scales, then turns about x, then y, then z, then moves.
  static Affine fromParts(const Point& translate, const Point& rotateRad, const Point& scale);
};

// Where coordinates should count from so that floats resolve a scene of these bounds: the origin of
// the files unless the scene lies many times its own size away from it.
Point sceneOrigin(const Point& lower, const Point& upper);
// A place of the files in the coordinates of the scene.
Vec3 fromOrigin(const Point& p, const Point& origin);

class ObjLoader {
 public:
  explicit ObjLoader(Scene& scene) : scene_(scene) {}

  // Adds one OBJ. `materials` replaces the libraries that the OBJ names; empty: those are used.
  // Throws InputError when a file cannot be read at all; what can be repaired goes to
  // scene.warnings.
  void load(const fs::path& obj, const fs::path& materials, const Affine& transform);

  // After the last OBJ: rounds the vertices to floats, leaves out the triangles that have no area
  // or normal then, puts opaque ones first, computes bounds and origin, pads the vertex buffer.
  void finish();

 private:
  struct Parsed;
  struct WantedTexture {
    std::string key;  // in textures_
    fs::path file;
    bool srgb, mask;
    std::array<float, 2> scale, offset;
  };
  // From here on a number stands for an entry of wanted_ rather than for a texture.
  static constexpr uint32_t kWanted = 1u << 31;

  void warn(const std::string& text);
  uint32_t texture(const fs::path& folder, const fs::path& otherFolder, std::string name, bool srgb,
                   bool mask, const float* scale, const float* offset);
  // `source` is a tinyobj material; textures are looked for beside its library, then beside the
  // OBJ.
  uint32_t addMaterial(const fs::path& library, const fs::path& obj, const void* source);
  uint32_t fallbackMaterial(const fs::path& obj);
  void loadWantedTextures(size_t firstMaterial);
  void addTriangles(const fs::path& obj, const Parsed& parsed, const Affine& transform);
  void roundPositions();
  void dropUnusable();
  void dropDoubledLamps();

  Scene& scene_;
  std::vector<Point> points_;  // what scene_.positions will be
  struct Part {
    fs::path obj;
    size_t endTriangle;
  };
  std::vector<Part> parts_;
  std::set<std::string> warned_;
  std::map<std::string, uint32_t> textures_;  // by path and use
  std::vector<WantedTexture> wanted_;         // of the OBJ that is being loaded
};

}  // namespace bnvpl
