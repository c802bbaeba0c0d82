#include "scene/surface_area.h"

#include <cmath>
#include <map>

namespace bnvpl {
namespace {

double areaOf(const Scene& scene, uint32_t begin, uint32_t end) {
  double area = 0.0;
  for (uint32_t t = begin; t < end; ++t) {
    const Vec3 a = scene.corner(t, 0), b = scene.corner(t, 1), c = scene.corner(t, 2);
    area += 0.5 * double{length(cross(b - a, c - a))};
  }
  return area;
}

}  // namespace

double areaFactor(const Instance& instance) {
  const Vec3 x = instance.vector({1, 0, 0}), y = instance.vector({0, 1, 0}),
             z = instance.vector({0, 0, 1});
  return std::pow(std::fabs(double{dot(x, cross(y, z))}), 2.0 / 3.0);
}

double surfaceArea(const Scene& scene) {
  double area = areaOf(scene, 0, scene.worldEnd());
  std::map<uint32_t, double> ofPrototypes;
  for (const Instance& instance : scene.instances) {
    const auto [known, isNew] = ofPrototypes.try_emplace(instance.prototype);
    const Prototype& p = scene.prototypes[instance.prototype];
    if (isNew) known->second = areaOf(scene, p.begin, p.end);
    area += known->second * areaFactor(instance);
  }
  return area;
}

}  // namespace bnvpl
