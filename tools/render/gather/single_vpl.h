// Contributions of single VPLs at one point.
#pragma once

#include "tools/render/gather/gather.h"

namespace bnvpl {

// Adds the contribution of VPL i, times `weight`. `groups` receives the radiance by light group.
inline void addTransfer(const VplLights& vpls, size_t i, const VplTransfer& c, float weight,
                        const LightGroupSink& groups, Gathered& out) {
  const Vec3 light = c.transfer * vpls.intensity[i] * weight;
  out.radiance += light;
  out.clamped += light * c.clampLoss;
  if (groups) vpls.addByGroup(i, c.transfer * weight, groups);
}

// Borrows accel, vpls and bsdf. `groups` receives the radiance by light group.
class ShadowTest {
 public:
  ShadowTest(const Accelerator& accel, const VplLights& vpls, const Bsdf& bsdf,
             const LightGroupSink& groups = {})
      : accel_(accel),
        vpls_(vpls),
        bsdf_(bsdf),
        groups_(groups),
        from_(accel.offsetOrigin(bsdf.point().position, bsdf.point().ng)) {}

  Gathered of(size_t i) const {
    Gathered out;
    add(i, 1.0f, out);
    return out;
  }
  // Adds the contribution of VPL i, times `weight`, if it is visible. Traces no ray if the
  // contribution is 0 anyway.
  void add(size_t i, float weight, Gathered& out) const {
    VplTransfer c;
    if (!unoccludedTransfer(vpls_, i, bsdf_, c)) return;
    ++out.shadowRays;
    out.sampledPairs += c.sampled;
    if (accel_.occluded(from_, vpls_.position[i])) return;
    addTransfer(vpls_, i, c, weight, groups_, out);
  }

 private:
  const Accelerator& accel_;
  const VplLights& vpls_;
  const Bsdf& bsdf_;
  LightGroupSink groups_;
  Vec3 from_;
};

}  // namespace bnvpl
