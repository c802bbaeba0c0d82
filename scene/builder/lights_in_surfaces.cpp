#include "scene/builder/lights_in_surfaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "core/number_text.h"

namespace bnvpl {
namespace {

using TriangleCorners = std::array<Vec3, 3>;

// Whether the projection of a point near the triangle's plane lies in the triangle.
bool isInside(Vec3 p, const TriangleCorners& c, Vec3 normal) {
  for (size_t i = 0; i < 3; ++i) {
    const Vec3 edge = c[(i + 1) % 3] - c[i];
    if (dot(cross(edge, p - c[i]), normal) < 0.0f) return false;
  }
  return true;
}

// The lights in the order of their x, so that a triangle looks at few of them.
class Lights {
 public:
  explicit Lights(const Scene& scene) : distance_(scene.offsetSize() * 0x1p-18f) {
    for (size_t i = 0; i < scene.lights.size(); ++i) {
      const LightSpec& light = scene.lights[i];
      if (light.pointOrSpot()) sorted_.push_back({light.position, i});
    }
    std::ranges::sort(sorted_, {}, [](const Light& light) { return light.position.x; });
    for (const Light& light : sorted_) box_.extend(light.position);
  }
  bool empty() const { return sorted_.empty(); }

  bool areNear(const Bounds& box) const {
    for (size_t axis = 0; axis < 3; ++axis) {
      if (box.lower[axis] > box_.upper[axis] + distance_) return false;
      if (box.upper[axis] < box_.lower[axis] - distance_) return false;
    }
    return true;
  }
  // Notes the lights that lie in the triangle.
  void meet(const TriangleCorners& c, uint32_t material) {
    Bounds box;
    for (const Vec3 p : c) box.extend(p);
    if (!areNear(box)) return;
    const Vec3 normal = normalize(cross(c[1] - c[0], c[2] - c[0]));
    auto light = std::ranges::lower_bound(sorted_, box.lower.x - distance_, {},
                                          [](const Light& l) { return l.position.x; });
    for (; light != sorted_.end() && light->position.x <= box.upper.x + distance_; ++light) {
      const Vec3 p = light->position;
      if (std::fabs(dot(p - c[0], normal)) <= distance_ && isInside(p, c, normal))
        found_.try_emplace(light->number, material);
    }
  }
  const std::map<size_t, uint32_t>& found() const { return found_; }  // light -> material

 private:
  struct Light {
    Vec3 position;
    size_t number;
  };
  std::vector<Light> sorted_;
  Bounds box_;
  float distance_;
  std::map<size_t, uint32_t> found_;
};

void meetRange(const Scene& scene, uint32_t begin, uint32_t end, const Instance* at,
               Lights& lights) {
  for (uint32_t t = begin; t < end; ++t) {
    TriangleCorners c{scene.corner(t, 0), scene.corner(t, 1), scene.corner(t, 2)};
    if (at) std::ranges::transform(c, c.begin(), [&](Vec3 p) { return at->point(p); });
    lights.meet(c, scene.triangles[t].material);
  }
}

}  // namespace

std::string lightsInSurfaces(const Scene& scene) {
  Lights lights(scene);
  if (lights.empty()) return {};
  meetRange(scene, 0, scene.worldEnd(), nullptr, lights);
  std::vector<Bounds> boxes;
  for (const Prototype& p : scene.prototypes) boxes.push_back(scene.boxOf(p));
  for (const Instance& instance : scene.instances) {
    const Prototype& p = scene.prototypes[instance.prototype];
    if (!lights.areNear(instance.box(boxes[instance.prototype]))) continue;
    meetRange(scene, p.begin, p.end, &instance, lights);
  }
  if (lights.found().empty()) return {};
  const auto& [number, material] = *lights.found().begin();
  const Vec3 p = scene.lights[number].position;
  const std::string& name = scene.materials[material].name;
  const std::string more = lights.found().size() == 1
                               ? ""
                               : " (and " + std::to_string(lights.found().size() - 1) + " more)";
  return scene.name() + ": the light at (" + shortestText(p.x) + ", " + shortestText(p.y) + ", " +
         shortestText(p.z) + ")" + more + " lies in a surface" +
         (name.empty() ? "" : " of '" + name + "'") +
         ": rounding decides what it lights; move it to the side that it should light";
}

}  // namespace bnvpl
