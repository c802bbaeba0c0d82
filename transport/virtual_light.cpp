#include "transport/virtual_light.h"

#include <algorithm>
#include <span>

#include "core/sampling.h"

namespace bnvpl {

VplLights makeVplLights(const VplTable& lit, const RayScene& rays, float clamp, LightKind kind,
                        const VplGroups& groups, float oneRadius) {
  VplLights lights;
  lights.groups = groups.groups;
  lights.kind = kind;
  // Min distance, below which rays cannot tell points apart. It keeps 1/d^2 finite without a clamp.
  const float nearest = rays.scene().offsetSize() * 0x1p-20f;
  for (size_t i = 0; i < lit.size(); ++i) {
    if (!(mean(lit.flux[i]) * (1.0f / kPi) > 0.0f)) continue;  // dark, or too faint for floats
    ++lights.vplCount;
    // Each emission point emits an equal part of the flux; coinciding points become one light.
    const auto at = std::span(lit.emitPosition).subspan(i * lit.emitPoints, lit.emitPoints);
    for (size_t k = 0; k < at.size(); ++k) {
      if (std::find(at.begin(), at.end(), at[k]) != at.begin() + std::ptrdiff_t(k)) continue;
      const auto same = std::count(at.begin(), at.end(), at[k]);
      const Vec3 normal = lit.emitNormal[i * lit.emitPoints + k];
      const float part = static_cast<float>(same) / static_cast<float>(lit.emitPoints);
      lights.row.push_back(static_cast<uint32_t>(i));
      lights.position.push_back(rays.offsetOrigin(at[k], normal));
      lights.normal.push_back(normal);
      lights.intensity.push_back(lit.flux[i] * (part / kPi));
      for (uint32_t g = 0; g < groups.groups; ++g)
        lights.groupIntensity.push_back(groups.flux[i * groups.groups + g] * (part / kPi));
      const float radius = oneRadius > 0.0f ? oneRadius : lit.radius[i];
      lights.clamp2.push_back(std::max(clamp * clamp * radius * radius, nearest * nearest));
    }
  }
  return lights;
}

}  // namespace bnvpl
