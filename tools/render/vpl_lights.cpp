#include "tools/render/vpl_lights.h"

#include "core/sampling.h"

namespace bnvpl {

VplLights makeVplLights(const VplTable& lit, const RayScene& rays, float clamp) {
  VplLights vpls;
  for (size_t i = 0; i < lit.size(); ++i) {
    if (isBlack(lit.flux[i])) continue;
    vpls.position.push_back(rays.lifted(lit.position[i], lit.normal[i]));
    vpls.normal.push_back(lit.normal[i]);
    vpls.intensity.push_back(lit.flux[i] * (1.0f / kPi));
    vpls.clamp2.push_back(clamp * clamp * lit.radius[i] * lit.radius[i]);
  }
  return vpls;
}

}  // namespace bnvpl
