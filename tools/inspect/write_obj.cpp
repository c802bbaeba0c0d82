#include <cmath>
#include <map>

#include "core/number_text.h"
#include "scene/affine.h"
#include "tools/inspect/write_scene.h"

namespace bnvpl {

namespace {

// Numbers from 1, in the order of first use.
class Numbering {
 public:
  std::vector<uint32_t> used;
  size_t of(uint32_t index) {
    const auto [it, isNew] = numbers_.try_emplace(index, used.size() + 1);
    if (isNew) used.push_back(index);
    return it->second;
  }

 private:
  std::map<uint32_t, size_t> numbers_;
};

bool isFinite(const std::array<float, 2>& uv) {
  return std::isfinite(uv[0]) && std::isfinite(uv[1]);
}

}  // namespace

// Consecutive triangles of a material stand together; the order is the scene's.
std::string objText(const Scene& scene, uint32_t begin, uint32_t end) {
  const bool world = begin < scene.worldEnd();
  Numbering positions, normals, uvs;
  std::string faces;
  uint32_t material = kNone;
  for (uint32_t i = begin; i < end; ++i) {
    const Triangle& t = scene.triangles[i];
    if (t.material != material) faces += "usemtl " + materialName(scene, t.material) + "\n";
    material = t.material;
    faces += "f";
    for (size_t k = 0; k < 3; ++k) {
      const bool uv = t.uv[k] != kNone && isFinite(scene.uvs[t.uv[k]]);
      faces += " " + std::to_string(positions.of(t.position[k]));
      if (uv) faces += "/" + std::to_string(uvs.of(t.uv[k]));
      if (t.normal[k] != kNone)
        faces += (uv ? "/" : "//") + std::to_string(normals.of(t.normal[k]));
    }
    faces += "\n";
  }
  std::string text = "mtllib scene.mtl\n";
  for (const uint32_t i : positions.used) {
    const Vec3 p = scene.positions[i];
    text += "v";
    for (size_t k = 0; k < 3; ++k) {
      const double origin = world ? scene.origin[k] : 0.0;
      text += " " + (origin == 0.0 ? shortestText(p[k]) : shortestText(p[k] + origin));
    }
    text += "\n";
  }
  for (const uint32_t i : normals.used) {
    const Vec3 n = scene.normals[i];
    text += "vn " + shortestText(n.x) + " " + shortestText(n.y) + " " + shortestText(n.z) + "\n";
  }
  for (const uint32_t i : uvs.used) {
    text += "vt " + shortestText(scene.uvs[i][0]) + " " + shortestText(scene.uvs[i][1]) + "\n";
  }
  return text + faces;
}

}  // namespace bnvpl
