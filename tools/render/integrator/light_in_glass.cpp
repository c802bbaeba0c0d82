#include "tools/render/integrator/light_in_glass.h"

#include <algorithm>

#include "transport/bsdf.h"

namespace bnvpl {

namespace {

// Material of a surface that lets light through, or null.
const Material* glassOf(const Scene& scene) {
  const auto found = std::ranges::find_if(
      scene.triangles, [&](const Triangle& t) { return isGlass(scene, t.material); });
  return found == scene.triangles.end() ? nullptr : &scene.materials[found->material];
}

}  // namespace

std::string lightMissedInGlass(const Scene& scene, const LightSet& lights,
                               std::string_view integrator) {
  const bool path = integrator == "path";
  for (size_t i = 0; i < lights.size(); ++i) {
    if (lights.hittable(i) || !(mean(lights.power(i)) > 0.0f)) continue;
    const Material* glass = glassOf(scene);
    if (!glass) return {};
    const std::string missed =
        " misses light of the " + lights.name(i) + " through material '" + glass->name + "'";
    return scene.name() + ": --integrator " + std::string(integrator) + missed +
           (path ? "; use --integrator vpl, guided or light, or give the light a size"
                 : ", where the camera sees it over a mirror or through glass; give the light a "
                   "size");
  }
  return {};
}

}  // namespace bnvpl
