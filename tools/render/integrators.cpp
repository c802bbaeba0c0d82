#include "tools/render/integrators.h"

namespace bnvpl {

namespace {

// Vertices beyond the first that a near-field ray may add; each follows with the missing share
// alone.
constexpr unsigned kMaxExtensions = 16;
// VPLs that light what a near-field ray found, which has more noise of its own the further it is
// down the path (measured: docs/theory.md, "Near field").
constexpr unsigned kFirstDraws = 8, kLaterDraws = 2;
constexpr uint32_t kDrawDirection = 16;  // dimension of a tile's random numbers, after its gather's

// The camera's part of a path, the same for both integrators.
ChainEnd seeFrom(const RayScene& rays, const LightSet& lights, Vec3 origin, Vec3 direction,
                 Rng& rng, RadianceSample& out) {
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

void VplIntegrator::render(const TileSamples& tile) const {
  // All vertices first, then their VPLs together, then the rest sample by sample.
  const size_t count = tile.samples.size();
  std::vector<ChainEnd> seen(count);
  std::vector<Bsdf> made;
  std::vector<const Bsdf*> bsdf(count, nullptr);
  made.reserve(count);
  for (size_t i = 0; i < count; ++i) {
    CameraSample& s = tile.samples[i];
    s.radiance = {};
    seen[i] = seeFrom(rays_, lights_, s.origin, s.direction, s.rng, s.radiance);
    if (!seen[i].rough) continue;
    bsdf[i] = &made.emplace_back(rays_.scene(), seen[i].hit);
    describeVertex(*bsdf[i], s.radiance);
  }
  if (only_ != Only::Direct) gather(tile, seen, bsdf);
  for (size_t i = 0; i < count; ++i) {
    if (!bsdf[i]) continue;
    CameraSample& s = tile.samples[i];
    const Vec3 throughput = seen[i].throughput;
    if (only_ != Only::Indirect) {
      s.radiance.direct += throughput * directLight(rays_, lights_, *bsdf[i], LobeGroup::Rough,
                                                    LightChoice::Each, extensions_, s.rng);
    }
    // The rays of all samples of a pixel are one set of points: the hemisphere is much the same for
    // each of them. The sequence repeats after 2^32 points.
    const auto slot = tile.firstSlot + static_cast<uint32_t>(i / tile.pixels);
    const uint64_t pixelKey = random64(tile.key, i % tile.pixels, kDrawDirection);
    for (unsigned k = 0; k < extensions_; ++k) {
      extend(seen[i], owenSobol(slot * extensions_ + k, pixelKey),
             throughput * (1.0f / static_cast<float>(extensions_)), s.rng, s.radiance);
    }
  }
}

void VplIntegrator::gather(const TileSamples& tile, std::span<const ChainEnd> seen,
                           std::span<const Bsdf* const> bsdf) const {
  std::vector<Gathered> gathered(bsdf.size());
  gatherer_.gather({tile, bsdf}, gathered);
  for (size_t i = 0; i < gathered.size(); ++i) {
    RadianceSample& out = tile.samples[i].radiance;
    out.indirect += seen[i].throughput * gathered[i].radiance;
    out.clamped += seen[i].throughput * gathered[i].clamped;
    out.cut += gathered[i].cut;
    out.shadowRays += gathered[i].shadowRays;
  }
}

// One ray for the light over a mirror, glass or sharp lobe (VPLs shine in straight lines), and for
// what NearField says is missing: from the scattered light that a VPL knows where it speaks for the
// point that the ray found, else by lighting that point as the first one, and so on. A light that
// it meets is the other half of the MIS of light sampling. All else is left to the VPLs.
// `firstAt` says where on the hemisphere the first ray goes.
void VplIntegrator::extend(ChainEnd vertex, Point2 firstAt, Vec3 throughput, Rng& rng,
                           RadianceSample& out) const {
  for (unsigned links = 0; links < kMaxExtensions; ++links) {
    const Bsdf bsdf(rays_.scene(), vertex.hit);
    const bool first = links == 0;
    BsdfSample next;
    const float pick = rng.next();
    const Point2 at = first ? firstAt : Point2{rng.next(), rng.next()};
    if (!bsdf.sample(LobeGroup::Rough, Transport::Radiance, pick, at, next)) return;
    throughput *= next.weight;
    const Vec3 from = rays_.lifted(vertex.hit.position, next.side);
    const Arrival arrival = first ? Arrival{next.pdf * static_cast<float>(extensions_),
                                            vertex.hit.position, LightChoice::Each}
                                  : Arrival{next.pdf, vertex.hit.position};
    const ChainEnd end = followChain(rays_, lights_, from, next.wi, arrival, rng);
    if (first && only_ != Only::Indirect) out.direct += throughput * end.metFirst;
    if (only_ == Only::Direct) return;
    Vec3 light = throughput * (end.metLater + (first ? Vec3{} : end.metFirst));
    const NearField::Missing missing = missingFrom(end, rng);
    throughput *= end.throughput;
    // Where a VPL knows the scattered light the path ends, so nothing shares the straight light
    // with the shadow ray. Else it goes on, by roulette at full weight.
    const bool known = missing.scattered.has_value();
    const bool lit = known ? missing.share > 0.0f : rng.next() < missing.share;
    if (lit) {
      const Bsdf found(rays_.scene(), end.hit);
      const Vec3 leaving = directLight(rays_, lights_, found, LobeGroup::Rough, LightChoice::One,
                                       known ? 0 : 1, rng);
      if (known) {
        light += throughput * (leaving + *missing.scattered) * missing.share;
      } else {
        const Gathered g = gatherer_.sample(found, first ? kFirstDraws : kLaterDraws, rng);
        light += throughput * (leaving + g.radiance);
        out.clamped += throughput * g.clamped;
        out.shadowRays += g.shadowRays;
      }
    }
    out.extended += light;
    out.indirect += light;
    if (known || !lit) return;
    vertex = end;
  }
}

NearField::Missing VplIntegrator::missingFrom(const ChainEnd& end, Rng& rng) const {
  if (!end.rough) return {};
  if (end.links > 0) return {1.0f, {}};
  return nearField_ ? nearField_->missing(end.hit, end.hit.distance, rng) : NearField::Missing{};
}

void PathTracer::render(const TileSamples& tile) const {
  for (CameraSample& s : tile.samples) s.radiance = trace(s, s.rng);
}

RadianceSample PathTracer::trace(const CameraSample& sample, Rng& rng) const {
  RadianceSample out;
  ChainEnd vertex = seeFrom(rays_, lights_, sample.origin, sample.direction, rng, out);
  Vec3 throughput = vertex.throughput;
  for (unsigned bounce = 0; vertex.rough; ++bounce) {
    const Bsdf bsdf(rays_.scene(), vertex.hit);
    if (bounce == 0) describeVertex(bsdf, out);
    if (only_ == Only::Direct && bounce > 0) return out;
    Vec3& sum = bounce == 0 ? out.direct : out.indirect;
    sum +=
        throughput * directLight(rays_, lights_, bsdf, LobeGroup::Rough, LightChoice::One, 1, rng);

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
