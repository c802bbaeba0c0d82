// Unbiased estimate of the light of all VPLs at a single point.
#pragma once

#include "tools/render/gather/gather.h"
#include "tools/render/light_tree/vpl_sampler.h"

namespace bnvpl {

// Samples VPLs with a VplSampler. Thread-safe.
class PointGather {
 public:
  PointGather(const Accelerator& accel, const VplLights& vpls, const LightTree& tree)
      : accel_(accel), vpls_(vpls), sampler_(tree) {}
  Gathered operator()(const Bsdf& bsdf, unsigned draws, Rng& rng,
                      const LightGroupSink& groups = {}) const;

 private:
  const Accelerator& accel_;
  const VplLights& vpls_;
  VplSampler sampler_;
};

}  // namespace bnvpl
