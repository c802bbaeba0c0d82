#include "tools/render/integrator/path_tracer.h"

#include "tools/render/camera_path.h"
#include "transport/outgoing_radiance.h"

namespace bnvpl {

void PathTracer::render(const TileSamples& tile) const {
  for (CameraSample& s : tile.samples) s.radiance = trace(s, s.rng);
}

RadianceSample PathTracer::trace(const CameraSample& sample, Rng& rng) const {
  return tracePath(accel_, lights_, sample, shown_, indirect_, rng,
                   [&](const Bsdf& bsdf, Vec3 throughput, bool directOnly, RadianceSample& out) {
                     addOutgoingRadiance(accel_, lights_, bsdf, throughput,
                                         {maxBounces_, directOnly}, nullptr, rng, out.direct,
                                         out.indirect,
                                         {sample.groups.direct(), sample.groups.indirect()});
                   });
}

}  // namespace bnvpl
