// OBJ and MTL files -> triangles, materials and textures of a Scene.
#pragma once

#include <array>
#include <map>
#include <set>
#include <string>

#include "scene/scene.h"

namespace bnvpl {

// Row-major 3x4 matrix, applied to column vectors.
struct Affine {
  std::array<std::array<float, 4>, 3> m{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

  Vec3 point(Vec3 p) const;
  Vec3 normal(Vec3 n) const;  // by the inverse transpose; unit length
  float determinant() const;  // negative: mirrors, so that windings must turn
  // Scales, then turns about x, then y, then z, then moves.
  static Affine fromParts(Vec3 translate, Vec3 rotateRad, Vec3 scale);
};

class ObjLoader {
 public:
  explicit ObjLoader(Scene& scene) : scene_(scene) {}

  // Adds one OBJ. `materials` replaces the libraries that the OBJ names; empty: those are used.
  // Throws InputError when a file cannot be read at all; what can be repaired goes to
  // scene.warnings.
  void load(const fs::path& obj, const fs::path& materials, const Affine& transform);

  // After the last OBJ: puts opaque triangles first, computes bounds, pads the vertex buffer.
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

  Scene& scene_;
  std::set<std::string> warned_;
  std::map<std::string, uint32_t> textures_;  // by path and use
  std::vector<WantedTexture> wanted_;         // of the OBJ that is being loaded
};

}  // namespace bnvpl
