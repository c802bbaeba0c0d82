#include <algorithm>
#include <cmath>
#include <vector>

#include "core/number_text.h"
#include "scene/affine.h"
#include "tools/inspect/scene/write_scene.h"

namespace bnvpl {

namespace {

// Numbers the indices that are used from 1, in ascending order.
class Numbering {
 public:
  std::vector<uint32_t> used;
  void finish() {
    std::ranges::sort(used);
    used.erase(std::unique(used.begin(), used.end()), used.end());
  }
  std::string operator[](uint32_t index) const {
    return std::to_string(std::ranges::lower_bound(used, index) - used.begin() + 1);
  }
};

bool isFinite(const std::array<float, 2>& uv) {
  return std::isfinite(uv[0]) && std::isfinite(uv[1]);
}

std::string placeText(Vec3 p, const FilePoint& origin) {
  std::string text;
  for (size_t k = 0; k < 3; ++k)
    text += " " + (origin[k] == 0.0 ? shortestText(p[k]) : shortestText(p[k] + origin[k]));
  return text;
}

}  // namespace

// Keeps the scene's order of triangles, with faces that were cut behind them, and one usemtl for
// consecutive triangles of one material, and one o for those of one object.
std::string objText(const Scene& scene, uint32_t begin, uint32_t end,
                    const std::vector<std::string>& names,
                    const std::vector<std::string>& objects) {
  const bool world = begin < scene.worldEnd();
  std::vector<ObjectTriangle> triangles;
  for (uint32_t i = begin; i < end; ++i) {
    if (const Triangle& t = scene.triangles[i]; !scene.isPiece(t))
      triangles.push_back({t, scene.objectOf(i)});
  }
  if (world) triangles.insert(triangles.end(), scene.cutFaces.begin(), scene.cutFaces.end());
  const auto hasUv = [&](const Triangle& t, size_t k) {
    return t.uv[k] != kNone && isFinite(scene.uvs[t.uv[k]]);
  };
  Numbering positions, normals, uvs;
  for (const auto& [t, object] : triangles) {
    for (size_t k = 0; k < 3; ++k) {
      positions.used.push_back(t.position[k]);
      if (t.normal[k] != kNone) normals.used.push_back(t.normal[k]);
      if (hasUv(t, k)) uvs.used.push_back(t.uv[k]);
    }
  }
  for (Numbering* n : {&positions, &normals, &uvs}) n->finish();

  std::string text = "mtllib scene.mtl\n";
  for (const uint32_t i : positions.used)
    text += "v" + placeText(scene.positions[i], world ? scene.origin : FilePoint{}) + "\n";
  for (const uint32_t i : normals.used) text += "vn" + placeText(scene.normals[i], {}) + "\n";
  for (const uint32_t i : uvs.used)
    text += "vt " + shortestText(scene.uvs[i][0]) + " " + shortestText(scene.uvs[i][1]) + "\n";
  uint32_t material = kNone, object = kNone;
  for (const auto& [t, here] : triangles) {
    if (here != object) text += "o " + objects[here] + "\n";
    object = here;
    if (t.material != material) text += "usemtl " + names[t.material] + "\n";
    material = t.material;
    text += "f";
    for (size_t k = 0; k < 3; ++k) {
      text += " " + positions[t.position[k]];
      if (hasUv(t, k)) text += "/" + uvs[t.uv[k]];
      if (t.normal[k] != kNone) text += (hasUv(t, k) ? "/" : "//") + normals[t.normal[k]];
    }
    text += "\n";
  }
  return text;
}

}  // namespace bnvpl
