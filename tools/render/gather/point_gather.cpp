#include "tools/render/gather/point_gather.h"

#include "tools/render/gather/single_vpl.h"

namespace bnvpl {

Gathered PointGather::operator()(const Bsdf& bsdf, unsigned draws, Rng& rng,
                                 const LightGroupSink& groups) const {
  Gathered out;
  const VplSampler::Point point(sampler_, bsdf);
  if (point.dark()) return out;
  const ShadowTest visible(accel_, vpls_, bsdf, groups);
  const float shift = rng.next(), perDraw = 1.0f / static_cast<float>(draws);
  for (unsigned k = 0; k < draws; ++k) {
    const auto draw = point.draw((static_cast<float>(k) + shift) * perDraw, rng);
    if (draw) visible.add(draw->vpl, perDraw / draw->probability, out);
  }
  return out;
}

}  // namespace bnvpl
