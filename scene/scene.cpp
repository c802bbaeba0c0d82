#include "scene/scene.h"

#include <algorithm>

#include "core/files.h"

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

std::string Scene::noLight() const {
  const std::string problem = name() + ": has no light with power: its images are black; ";
  if (isToml()) return problem + "add a [[light]] or an emissive material (Ke)";
  const std::string mesh = files.front().filename().string();
  fs::path lit = files.front();
  lit.replace_filename(lit.stem().string() + "-lit.toml");
  if (lit.string().find_first_of("'\"\\%") != std::string::npos)
    return problem +
           "name it in the [[mesh]] of a scene.toml that has a [[light]], and render that";
  return problem +
         "render a scene.toml with a [[light]] around it, such as that of: printf 'mesh = "
         "[{file = \"" +
         mesh +
         "\"}]\\nlight = [{type = \"environment\", radiance = [1, 1, 1]}]"
         "\\n' > '" +
         lit.string() + "'";
}

void Scene::requireLight() const {
  if (!hasLight()) throw InputError(noLight());
}

bool Scene::isToml() const { return !files.empty() && lowerExtension(files.front()) == ".toml"; }

}  // namespace bnvpl
