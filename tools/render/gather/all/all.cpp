// Sums all VPLs at every point: the reference for a set of VPLs, to which the other methods are
// compared.
#include "tools/render/gather/gather.h"
#include "tools/render/gather/rgb_sum.h"

namespace bnvpl::methods::gather::all {

namespace {

Gathered gatherAll(const Accelerator& accel, const VplLights& vpls, const Bsdf& bsdf,
                   const LightGroupSink& groups) {
  Gathered out;
  out.cut = static_cast<uint32_t>(vpls.size());
  const Vec3 from = accel.offsetOrigin(bsdf.point().position, bsdf.point().ng);
  RgbSum total, clamped;
  VplTransfer c;
  for (size_t i = 0; i < vpls.size(); ++i) {
    if (!unoccludedTransfer(vpls, i, bsdf, c)) continue;
    ++out.shadowRays;
    out.sampledPairs += c.sampled;
    if (accel.occluded(from, vpls.position[i])) continue;
    const Vec3 light = c.transfer * vpls.intensity[i];
    total.add(light);
    clamped.add(light * c.clampLoss);
    if (groups) vpls.addByGroup(i, c.transfer, groups);
  }
  out.radiance = total.toVec3();
  out.clamped = clamped.toVec3();
  return out;
}

Gather make(const GatherInputs& in, const Values&) {
  return gatherEach(
      [&accel = in.accel, &vpls = in.vpls](const Bsdf& bsdf, const LightGroupSink& groups) {
        return gatherAll(accel, vpls, bsdf, groups);
      });
}

}  // namespace

extern const GatherMethod method{.name = "all",
                                 .summary = "all VPLs: the reference for a set of VPLs",
                                 .options = {},
                                 .make = make};

}  // namespace bnvpl::methods::gather::all
