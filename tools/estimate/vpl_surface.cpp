#include "tools/estimate/vpl_surface.h"

#include "core/parallel.h"
#include "spatial/compatible_surface.h"

namespace bnvpl {

namespace {

// How far of the way a VPL moves (measured: guarded/theory.md), and how far above the surface it
// travels, as a share of its reach.
constexpr float kRecentreShare = 0.35f;
constexpr float kRecentreLift = 0.1f;

}  // namespace

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

void recentre(VplTable& lit, std::span<const Vec3> centre, const RayScene& rays) {
  parallelFor(lit.size(), 256, [&](size_t i) {
    if (!(mean(lit.flux[i]) > 0.0f)) return;
    const Vec3 position = lit.position[i], n = lit.normal[i];
    const float reach = static_cast<float>(lit.reach) * lit.radius[i], lift = kRecentreLift * reach;
    Vec3 offset = centre[i] * reach;
    offset = (offset + n * -dot(n, offset)) * kRecentreShare;
    const Vec3 above = position + offset + n * lift;
    SurfacePoint hit;
    if (rays.occluded(position + n * lift, above) || !rays.closestHit(above, -n, hit)) return;
    if (hit.distance > 2.0f * lift || dot(hit.ng, n) < kMinNormalDot) return;
    lit.emitPosition[i] = hit.position;
    lit.emitNormal[i] = hit.ng;
  });
}

}  // namespace bnvpl
