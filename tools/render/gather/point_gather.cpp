#include "tools/render/gather/point_gather.h"

namespace bnvpl {

Gathered PointGather::operator()(const Bsdf& bsdf, unsigned draws, Rng& rng,
                                 const GroupSink& groups) const {
  Gathered out;
  const VplSampler::Point point(sampler_, bsdf);
  if (point.dark()) return out;
  const Vec3 from = accel_.offsetOrigin(bsdf.point().position, bsdf.point().ng);
  const float shift = rng.next(), perDraw = 1.0f / static_cast<float>(draws);
  for (unsigned k = 0; k < draws; ++k) {
    const auto draw = point.draw((static_cast<float>(k) + shift) * perDraw, rng);
    VplTransfer c;
    if (!draw || !unoccludedTransfer(vpls_, draw->vpl, bsdf, c)) continue;
    ++out.shadowRays;
    out.sampledPairs += c.sampled;
    if (accel_.occluded(from, vpls_.position[draw->vpl])) continue;
    const float weight = perDraw / draw->probability;
    const Vec3 light = c.transfer * vpls_.intensity[draw->vpl] * weight;
    if (groups) vpls_.addByGroup(draw->vpl, c.transfer * weight, groups);
    out.radiance += light;
    out.clamped += light * c.clampLoss;
  }
  return out;
}

}  // namespace bnvpl
