#include "transport/virtual_light/virtual_light.h"

#include <algorithm>
#include <bit>
#include <span>

#include "core/random.h"
#include "core/sampling.h"
#include "transport/virtual_light/spherical/spherical_transfer.h"

namespace bnvpl {

VplLights makeVplLights(const VplTable& lit, const Accelerator& accel, float clamp, VplKind kind,
                        const VplGroups& groups, float oneRadius) {
  VplLights lights;
  lights.groups = groups.groups;
  lights.kind = kind;
  // Min distance, below which rays cannot tell points apart. It keeps 1/d^2 finite without a clamp.
  const float nearest = accel.scene().minRayOffset();
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
      lights.position.push_back(accel.offsetOrigin(at[k], normal));
      lights.normal.push_back(normal);
      lights.intensity.push_back(lit.flux[i] * (part / kPi));
      for (uint32_t g = 0; g < groups.groups; ++g)
        lights.groupIntensity.push_back(groups.flux[i * groups.groups + g] * (part / kPi));
      const float radius = oneRadius > 0.0f ? oneRadius : lit.radius[i];
      lights.size2.push_back(std::max(clamp * clamp * radius * radius, nearest * nearest));
    }
  }
  return lights;
}

// A shadow ray to a centre below the receiver's horizon would end at the receiver's own surface.
bool integratedTransfer(const VplLights& vpls, size_t i, const Bsdf& bsdf, Vec3 d,
                        VplTransfer& out) {
  const SurfacePoint& at = bsdf.point();
  if (!(dot(at.ng, d) > 0.0f)) return false;
  // Two surfaces that face the same way light each other in no direction.
  constexpr float kSameWay = 1.0f - 1e-6f;
  if (bsdf.diffuseOnly() && dot(at.ns, vpls.normal[i]) > kSameWay) return false;
  // Receivers are random points, so that their coordinates make a key that differs by sample and
  // depends on nothing else.
  uint64_t key = i;
  for (const float x : {at.position.x, at.position.y, at.position.z})
    key = mix64(key ^ std::bit_cast<uint32_t>(x));
  const SphericalLightTransfer found =
      sphericalTransfer({d, vpls.normal[i], vpls.size2[i]}, bsdf, key);
  out = {found.value, 0.0f, found.sampled};
  return !isBlack(out.transfer);
}

}  // namespace bnvpl
