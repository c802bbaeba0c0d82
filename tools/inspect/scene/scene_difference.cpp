#include "tools/inspect/scene/scene_difference.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "scene/visit_material.h"
#include "tools/inspect/scene/material_difference.h"

namespace bnvpl {

namespace {

constexpr float kRounding = 1e-5f;  // tolerance for numbers and unit vectors that went through text

bool near(float a, float b) {
  return std::fabs(a - b) <= kRounding * std::max({1.0f, std::fabs(a), std::fabs(b)});
}
bool near(Vec3 a, Vec3 b) {
  return length(a - b) <= kRounding * std::max({1e-30f, length(a), length(b)});
}

class Comparison {
 public:
  Comparison(const Scene& a, const Scene& b) : a_(a), b_(b) {}

  bool sameViews() const;
  bool sameLights() const;
  bool sameInstances() const;
  bool sameExtent() const;  // bounds, and the size by which ray origins are moved
  // Names the first material or triangle that differs; empty: none.
  std::string triangles(uint32_t beginA, uint32_t endA, uint32_t beginB, uint32_t endB);
  std::string prototypes();

 private:
  // Compares points in the coordinates of the files: those of the world have an origin to add.
  bool samePlace(Vec3 p, Vec3 q, bool world = true) const;
  bool sameCorner(const Triangle& t, const Triangle& u, size_t k, bool world) const;
  bool sameLight(const LightSpec& l, const LightSpec& m) const;

  const Scene &a_, &b_;
  std::map<std::pair<uint32_t, uint32_t>, bool> materials_;  // whether two materials are equal
};

bool Comparison::samePlace(Vec3 p, Vec3 q, bool world) const {
  const float size = std::max(a_.bounds.diagonal(), std::max(length(p), length(q)));
  for (size_t k = 0; k < 3; ++k) {
    const double from = world ? a_.origin[k] : 0.0, other = world ? b_.origin[k] : 0.0;
    if (!(std::fabs(p[k] + from - (q[k] + other)) <= double{kRounding} * double{size}))
      return false;
  }
  return true;
}

bool Comparison::sameViews() const {
  const Camera &c = a_.camera, &d = b_.camera;
  return a_.film.width == b_.film.width && a_.film.height == b_.film.height &&
         a_.film.filter == b_.film.filter && samePlace(c.position, d.position) &&
         near(c.forward, d.forward) && near(c.right, d.right) && near(c.up, d.up) &&
         near(c.verticalFovRad, d.verticalFovRad) && near(c.shift[0], d.shift[0]) &&
         near(c.shift[1], d.shift[1]) && c.lensRadius == d.lensRadius &&
         (!c.hasLens() || c.focusDistance == d.focusDistance);
}

bool Comparison::sameLight(const LightSpec& l, const LightSpec& m) const {
  const bool placed = l.pointOrSpot();
  const bool directed = l.type == LightType::Spot || l.type == LightType::Directional;
  if (l.type != m.type || l.image != m.image) return false;
  if (a_.lightGroups[l.group] != b_.lightGroups[m.group]) return false;
  if (placed && !samePlace(l.position, m.position)) return false;
  if (directed && !near(l.direction, m.direction)) return false;
  return (l.image != kNone || near(l.emission, m.emission)) && near(l.coneRad, m.coneRad) &&
         near(l.falloffRad, m.falloffRad) && near(l.angularRadiusRad, m.angularRadiusRad) &&
         near(l.rotateRad, m.rotateRad) && near(l.scale, m.scale);
}

bool Comparison::sameLights() const {
  const auto light = [&](const LightSpec& l, const LightSpec& m) { return sameLight(l, m); };
  const auto image = [](const EnvironmentImage& e, const EnvironmentImage& f) {
    return e.width == f.width && e.height == f.height && e.radiance == f.radiance;
  };
  return std::ranges::equal(a_.lights, b_.lights, light) &&
         std::ranges::equal(a_.environments, b_.environments, image);
}

bool Comparison::sameCorner(const Triangle& t, const Triangle& u, size_t k, bool world) const {
  if (!samePlace(a_.positions[t.position[k]], b_.positions[u.position[k]], world)) return false;
  const bool normal = t.normal[k] != kNone;
  if (normal != (u.normal[k] != kNone)) return false;
  if (normal && !near(a_.normals[t.normal[k]], b_.normals[u.normal[k]])) return false;
  const auto place = [](const Scene& s, uint32_t uv) {
    const std::array<float, 2> none{NAN, NAN};
    return uv == kNone ? none : s.uvs[uv];
  };
  const auto p = place(a_, t.uv[k]), q = place(b_, u.uv[k]);
  const bool given = std::isfinite(p[0]) && std::isfinite(p[1]);
  return given ? p == q : u.uv[k] == kNone;
}

std::string Comparison::triangles(uint32_t beginA, uint32_t endA, uint32_t beginB, uint32_t endB) {
  if (endA - beginA != endB - beginB) {
    return std::to_string(endA - beginA) + " triangles became " + std::to_string(endB - beginB);
  }
  const bool world = beginA < a_.worldEnd();
  for (uint32_t i = 0; i < endA - beginA; ++i) {
    const Triangle &t = a_.triangles[beginA + i], &u = b_.triangles[beginB + i];
    const auto [it, isNew] = materials_.try_emplace({t.material, u.material}, false);
    if (isNew) it->second = sameMaterial({a_, t.material}, {b_, u.material});
    if (!it->second) return "material '" + a_.materials[t.material].name + "'";
    for (size_t k = 0; k < 3; ++k) {
      if (!sameCorner(t, u, k, world)) return "triangle " + std::to_string(beginA + i);
    }
  }
  return "";
}

// Sorts instances by prototype, the order in which they are written.
std::vector<Instance> instancesInOrder(const Scene& scene) {
  std::vector<Instance> out = scene.instances;
  std::ranges::stable_sort(out, {}, &Instance::prototype);
  return out;
}

bool Comparison::sameInstances() const {
  const auto same = [&](const Instance& i, const Instance& j) {
    if (i.mirrored != j.mirrored || !samePlace(i.point({}), j.point({}))) return false;
    for (const Vec3 axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
      if (length(i.vector(axis) - j.vector(axis)) > kRounding * length(i.vector(axis)))
        return false;
    }
    return true;
  };
  return std::ranges::equal(instancesInOrder(a_), instancesInOrder(b_), same);
}

bool Comparison::sameExtent() const {
  const float size = a_.offsetSize();
  return samePlace(a_.bounds.lower, b_.bounds.lower) &&
         samePlace(a_.bounds.upper, b_.bounds.upper) &&
         std::fabs(size - b_.offsetSize()) <= kRounding * size;
}

std::string Comparison::prototypes() {
  const std::vector<Instance> of = instancesInOrder(a_), again = instancesInOrder(b_);
  std::string difference;
  for (size_t i = 0; i < of.size() && difference.empty(); ++i) {
    if (i > 0 && of[i].prototype == of[i - 1].prototype) continue;
    const Prototype &p = a_.prototypes[of[i].prototype], &q = b_.prototypes[again[i].prototype];
    difference = triangles(p.begin, p.end, q.begin, q.end);
  }
  return difference;
}

}  // namespace

std::string sceneDifference(const Scene& scene, const Scene& again) {
  Comparison comparison(scene, again);
  if (!comparison.sameViews()) return "camera or film";
  if (!comparison.sameLights()) return "a light";
  const std::string world = comparison.triangles(0, scene.worldEnd(), 0, again.worldEnd());
  if (!world.empty()) return world;
  if (!comparison.sameInstances()) return "an instance";
  if (!comparison.sameExtent()) return "which triangles lie far away";
  return comparison.prototypes();
}

}  // namespace bnvpl
