#include "scene/scene.h"

#include <algorithm>

namespace bnvpl {

namespace {

bool shines(const Scene& scene, const LightSpec& light) {
  if (light.type == LightType::Environment && light.scale == 0.0f) return false;
  if (light.image == kNone) return !isBlack(light.emission);
  const std::vector<Vec3>& radiance = scene.environments[light.image].radiance;
  return !std::all_of(radiance.begin(), radiance.end(), isBlack);
}

}  // namespace

uint32_t Scene::objectOf(uint32_t triangle, uint32_t instance) const {
  if (instance != kNone && instanceObjects[instance] != kNone) return instanceObjects[instance];
  const auto next = std::ranges::upper_bound(objectRuns, triangle, {}, &ObjectRun::firstTriangle);
  return std::prev(next)->object;
}

bool Scene::hasLight() const {
  return std::any_of(lights.begin(), lights.end(),
                     [&](const LightSpec& light) { return shines(*this, light); }) ||
         std::any_of(triangles.begin(), triangles.end(),
                     [&](const Triangle& t) { return !isBlack(materials[t.material].emission); });
}

void Scene::requireLight() const {
  if (!hasLight()) throw InputError(name() + ": " + kNoLight);
}

}  // namespace bnvpl
