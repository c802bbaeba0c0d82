#include "tools/render/integrators.h"

namespace bnvpl {

namespace {

// The camera's part of a path, the same for both integrators.
ChainEnd seeFrom(const RayScene& rays, const LightSet& lights, Vec3 origin, Vec3 direction, Rng& rng,
                 RadianceSample& out) {
  const ChainEnd end = followChain(rays, lights, origin, direction, Arrival{}, rng);
  out.direct = end.metFirst + end.metLater;
  if (end.firstDistance < INFINITY) {
    out.depth = end.firstDistance * dot(direction, rays.scene().camera.forward);
  }
  return end;
}

void describeVertex(const Bsdf& bsdf, RadianceSample& out) {
  out.albedo = bsdf.roughAlbedo();
  out.normal = bsdf.point().ns;
}

}  // namespace

RadianceSample VplIntegrator::sample(Vec3 origin, Vec3 direction, Rng& rng) const {
  RadianceSample out;
  const ChainEnd seen = seeFrom(rays_, lights_, origin, direction, rng, out);
  if (!seen.rough) return out;
  const Bsdf bsdf(rays_.scene(), seen.hit);
  describeVertex(bsdf, out);
  if (only_ != Only::Indirect) {
    out.direct += seen.throughput * directLight(rays_, lights_, bsdf, LobeGroup::Rough, rng);
  }
  if (only_ != Only::Direct) {
    addGathered(bsdf, seen.throughput, out);
    if (chains_) extendThroughChain(bsdf, seen.throughput, rng, out);
  }
  return out;
}

void VplIntegrator::addGathered(const Bsdf& bsdf, Vec3 throughput, RadianceSample& out) const {
  const Gathered g = gatherer_.gather(bsdf);
  out.indirect += throughput * g.radiance;
  out.clamped += throughput * g.clamped;
  out.cut += g.cut;
  out.shadowRays += g.shadowRays;
}

// A VPL's light, or a light's own, that reaches the vertex over a mirror, glass or sharp lobe. A ray that
// meets rough lobes first adds nothing: the VPLs stand for those, and light sampling for the lights.
void VplIntegrator::extendThroughChain(const Bsdf& bsdf, Vec3 throughput, Rng& rng, RadianceSample& out) const {
  BsdfSample next;
  if (!bsdf.sample(LobeGroup::Rough, Transport::Radiance, rng, next)) return;
  const Vec3 from = rays_.lifted(bsdf.point().position, next.side);
  const ChainEnd end =
      followChain(rays_, lights_, from, next.wi, Arrival{next.pdf, bsdf.point().position}, rng);
  if (end.links == 0) return;
  throughput *= next.weight;
  out.indirect += throughput * end.metLater;
  if (!end.rough) return;
  const Bsdf behind(rays_.scene(), end.hit);
  throughput *= end.throughput;
  out.indirect += throughput * directLight(rays_, lights_, behind, LobeGroup::Rough, rng);
  addGathered(behind, throughput, out);
}

RadianceSample PathTracer::sample(Vec3 origin, Vec3 direction, Rng& rng) const {
  RadianceSample out;
  ChainEnd vertex = seeFrom(rays_, lights_, origin, direction, rng, out);
  Vec3 throughput = vertex.throughput;
  for (unsigned bounce = 0; vertex.rough; ++bounce) {
    const Bsdf bsdf(rays_.scene(), vertex.hit);
    if (bounce == 0) describeVertex(bsdf, out);
    if (only_ == Only::Direct && bounce > 0) return out;
    Vec3& sum = bounce == 0 ? out.direct : out.indirect;
    sum += throughput * directLightMis(rays_, lights_, bsdf, LobeGroup::Rough, rng);

    const float survive = bounce == 0 ? 1.0f : bsdf.reflectance();
    if (rng.next() >= survive) return out;
    BsdfSample next;
    if (!bsdf.sample(LobeGroup::Rough, Transport::Radiance, rng, next)) return out;
    throughput *= next.weight * (1.0f / survive);
    const Vec3 from = rays_.lifted(vertex.hit.position, next.side);
    const Arrival arrival{next.pdf, vertex.hit.position};
    vertex = followChain(rays_, lights_, from, next.wi, arrival, rng);
    sum += throughput * vertex.metFirst;
    out.indirect += throughput * vertex.metLater;
    if (bounce == maxBounces_) return out;
    throughput *= vertex.throughput;
  }
  return out;
}

}  // namespace bnvpl
