#include "tools/render/integrator/path_tracer.h"

#include "tools/render/integrator/camera_vertex.h"
#include "transport/walk.h"

namespace bnvpl {

void PathTracer::render(const TileSamples& tile) const {
  for (CameraSample& s : tile.samples) s.radiance = trace(s, s.rng);
}

RadianceSample PathTracer::trace(const CameraSample& sample, Rng& rng) const {
  RadianceSample out;
  SpecularPath vertex = seeFrom(rays_, lights_, sample.origin, sample.direction, rng, out);
  Vec3 throughput = vertex.throughput;
  const bool directOnly = only_ == Only::Direct || (!indirect_ && vertex.links == 0);
  if (directOnly && only_ == Only::Indirect && vertex.rough) {
    describeVertex(Bsdf(rays_.scene(), vertex.hit), out);
    return out;
  }
  for (unsigned bounce = 0; vertex.rough; ++bounce) {
    const Bsdf bsdf(rays_.scene(), vertex.hit);
    if (bounce == 0) describeVertex(bsdf, out);
    Vec3& sum = bounce == 0 ? out.direct : out.indirect;
    sum +=
        throughput * directLight(rays_, lights_, bsdf, LobeGroup::Rough, LightChoice::One, 1, rng);

    const float survive = bounce == 0 ? 1.0f : bsdf.reflectance();
    if (rng.next() >= survive) return out;
    BsdfSample scattered;
    Ray next;
    if (!scatter(rays_, bsdf, LobeGroup::Rough, Transport::Radiance, rng, scattered, next))
      return out;
    throughput *= scattered.weight * (1.0f / survive);
    const Arrival arrival{scattered.pdf, vertex.hit.position};
    vertex = followSpecularPath(rays_, lights_, next.origin, next.direction, arrival, rng);
    sum += throughput * vertex.metFirst;
    if (directOnly) return out;
    out.indirect += throughput * vertex.metLater;
    if (bounce == maxBounces_) return out;
    throughput *= vertex.throughput;
  }
  return out;
}

}  // namespace bnvpl
