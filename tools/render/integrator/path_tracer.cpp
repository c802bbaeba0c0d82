#include "tools/render/integrator/path_tracer.h"

#include "tools/render/integrator/camera_vertex.h"
#include "transport/leaving_light.h"

namespace bnvpl {

void PathTracer::render(const TileSamples& tile) const {
  for (CameraSample& s : tile.samples) s.radiance = trace(s, s.rng);
}

RadianceSample PathTracer::trace(const CameraSample& sample, Rng& rng) const {
  RadianceSample out;
  const SpecularPath vertex = seeFrom(rays_, lights_, sample.origin, sample.direction, rng, out);
  const bool directOnly = only_ == Only::Direct || (!indirect_ && vertex.links == 0);
  if (!vertex.rough) return out;
  const Bsdf bsdf(rays_.scene(), vertex.hit);
  describeVertex(bsdf, out);
  if (directOnly && only_ == Only::Indirect) return out;
  addLeavingLight(rays_, lights_, bsdf, vertex.throughput, {maxBounces_, directOnly}, rng,
                  out.direct, out.indirect);
  return out;
}

}  // namespace bnvpl
