#include "transport/virtual_light.h"

#include "core/sampling.h"

namespace bnvpl {

VplLights makeVplLights(const VplTable& lit, const RayScene& rays, float clamp, LightKind kind) {
  VplLights vpls;
  vpls.kind = kind;
  // Nothing nearer than rays can tell apart: 1/d^2 stays finite without a clamp too.
  const float nearest = rays.scene().bounds.diagonal() * 0x1p-20f;
  for (size_t i = 0; i < lit.size(); ++i) {
    if (!(mean(lit.flux[i]) * (1.0f / kPi) > 0.0f)) continue;  // dark, or too faint for floats
    vpls.row.push_back(static_cast<uint32_t>(i));
    vpls.position.push_back(rays.offsetOrigin(lit.emitPosition[i], lit.emitNormal[i]));
    vpls.normal.push_back(lit.emitNormal[i]);
    vpls.intensity.push_back(lit.flux[i] * (1.0f / kPi));
    vpls.clamp2.push_back(
        std::max(clamp * clamp * lit.radius[i] * lit.radius[i], nearest * nearest));
  }
  return vpls;
}

}  // namespace bnvpl
