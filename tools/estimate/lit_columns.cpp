#include "tools/estimate/lit_columns.h"

namespace bnvpl {

std::vector<float> reachOf(const VplTable& vpls, float radius) {
  std::vector<float> reach(vpls.radius);
  for (float& r : reach) r *= radius;
  return reach;
}

Coverage coverageOf(const VplTable& vpls, const Accelerator& accel, float radius) {
  return Coverage(vpls.position, vpls.normal, reachOf(vpls, radius), accel);
}

void beginLit(VplTable& vpls, float radius) {
  vpls.stage = VplStage::Lit;
  vpls.reachFactor = double{radius};
  vpls.flux.resize(vpls.size());
  vpls.photons.resize(vpls.size());
  vpls.relativeError.resize(vpls.size());
  vpls.firstBounceFlux.resize(vpls.size());
  vpls.emitPosition = vpls.position;
  vpls.emitNormal = vpls.normal;
}

void finishGroups(VplGroups groups, VplTable& lit) {
  const size_t count = groups.groups;
  if (count == 0) return;
  for (size_t i = 0; i < lit.size(); ++i) {
    const auto of = [&](std::vector<Vec3>& all) {
      return std::span(all).subspan(i * count, count);
    };
    addRoundingToLargest(of(groups.flux), lit.flux[i]);
    addRoundingToLargest(of(groups.firstBounceFlux), lit.firstBounceFlux[i]);
  }
  addVplGroups(groups, lit);
}

}  // namespace bnvpl
