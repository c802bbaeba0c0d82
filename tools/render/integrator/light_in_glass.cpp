#include "tools/render/integrator/light_in_glass.h"

#include <algorithm>
#include <array>

namespace bnvpl {

namespace {

bool letsThrough(const MaterialModel& model) {
  if (const auto* phong = std::get_if<PhongModel>(&model)) return phong->glass;
  if (const auto* pbr = std::get_if<MetallicRoughnessModel>(&model))
    return pbr->transmission.value > 0.0f;
  return std::holds_alternative<DielectricModel>(model);
}

// Material of a surface that lets light through, or null. A mix does if one of its parts does.
const Material* glassOf(const Scene& scene) {
  const auto transparent = [&](uint32_t m) {
    const Material& material = scene.materials[m];
    if (const auto* mix = std::get_if<MixModel>(&material.model)) {
      return std::ranges::any_of(std::array{mix->first, mix->second}, [&](uint32_t part) {
        return part != kNone && letsThrough(scene.materials[part].model);
      });
    }
    return letsThrough(material.model);
  };
  const auto found = std::ranges::find_if(
      scene.triangles, [&](const Triangle& t) { return transparent(t.material); });
  return found == scene.triangles.end() ? nullptr : &scene.materials[found->material];
}

}  // namespace

std::string lightMissedInGlass(const Scene& scene, const LightSet& lights,
                               std::string_view integrator) {
  const bool path = integrator == "path";
  if (!path && integrator != "guided" && integrator != "light") return {};
  for (size_t i = 0; i < lights.size(); ++i) {
    if (lights.hittable(i) || !(mean(lights.power(i)) > 0.0f)) continue;
    const Material* glass = glassOf(scene);
    if (!glass) return {};
    const std::string missed = " misses light of the " + lights.name(i) + " through material '" +
                               glass->name + "'";
    return scene.name() + ": --integrator " + std::string(integrator) + missed +
           (path ? "; use --integrator vpl, guided or light, or give the light a size"
                 : ", where the camera sees it over a mirror or through glass; use --integrator "
                   "vpl, or give the light a size");
  }
  return {};
}

}  // namespace bnvpl
