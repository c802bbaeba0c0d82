#include "tools/estimate/vpl_surface.h"

namespace bnvpl {

std::vector<float> reachOf(const VplTable& vpls, float radius) {
  std::vector<float> reach(vpls.radius);
  for (float& r : reach) r *= radius;
  return reach;
}

void beginLit(VplTable& vpls, float radius) {
  vpls.stage = VplStage::Lit;
  vpls.reach = double{radius};
  vpls.flux.resize(vpls.size());
  vpls.photons.resize(vpls.size());
  vpls.relativeError.resize(vpls.size());
  vpls.firstBounceFlux.resize(vpls.size());
  vpls.emitPosition = vpls.position;
  vpls.emitNormal = vpls.normal;
}

}  // namespace bnvpl
