#include "tools/render/integrator/vpl/vpl_integrator.h"

#include <algorithm>
#include <array>

#include "tools/render/integrator/camera_vertex.h"
#include "transport/walk.h"

namespace bnvpl {

namespace {

// Vertices beyond the first that a near-field ray may add; each follows with the missing share
// alone.
constexpr unsigned kMaxExtensions = 16;
// VPLs that light what a near-field ray found, which has more noise of its own the further it is
// down the path (measured: docs/theory.md, "Near field").
constexpr unsigned kFirstDraws = 8, kLaterDraws = 2;
constexpr uint32_t kDrawDirection = 16;  // dimension of a tile's random numbers, after its gather's
constexpr uint32_t kDrawLight = 1u << 30;

// Of sample i.
uint32_t slotOf(const TileSlots& tile, size_t i) {
  return tile.firstSlot + static_cast<uint32_t>(i / tile.pixels);
}

}  // namespace

// The rays of all samples of a pixel are points of one sequence: what they look for is much the
// same for each of them. The sequence repeats after 2^32 points.
struct VplIntegrator::Points {
  uint32_t slot;
  uint64_t directions, lights;  // keys
};

void VplIntegrator::render(const TileSamples& tile) const {
  // All vertices first, then their VPLs together, then the rest sample by sample.
  const size_t count = tile.samples.size();
  std::vector<SpecularPath> seen(count);
  std::vector<Bsdf> made;
  std::vector<const Bsdf*> bsdf(count, nullptr);
  made.reserve(count);
  for (size_t i = 0; i < count; ++i) {
    CameraSample& s = tile.samples[i];
    s.radiance = {};
    seen[i] = seeFrom(rays_, lights_, s.origin, s.direction, s.rng, s.radiance);
    if (seenLight_ && !directSamples_) {
      s.radiance.direct = seenLight_->withMoreRays(
          s.radiance.direct, 1, tile, static_cast<uint32_t>(i % tile.pixels), slotOf(tile, i));
    }
    if (!seen[i].rough) continue;
    bsdf[i] = &made.emplace_back(rays_.scene(), seen[i].hit);
    describeVertex(*bsdf[i], s.radiance);
  }
  if (only_ != Only::Direct) gatherTile(tile, seen, bsdf);
  const LearnedStrata strata = tileLights_ ? tileLights_->at(tile.x, tile.y) : LearnedStrata{};
  const LearnedLight learned{tileLights_ ? &strata : nullptr, lightRays_};
  for (size_t i = 0; i < count; ++i) {
    if (!bsdf[i]) continue;
    CameraSample& s = tile.samples[i];
    const Vec3 throughput = seen[i].throughput;
    const auto pixel = static_cast<uint32_t>(i % tile.pixels);
    const Points points{slotOf(tile, i), random64(tile.key, pixel, kDrawDirection),
                        random64(tile.key, pixel, kDrawLight)};
    if (only_ != Only::Indirect && !directSamples_)
      s.radiance.direct += throughput * directAt(*bsdf[i], learned, points, s.rng);
    const SharedWithPhotons shared =
        caustics_ && seen[i].links == 0 ? caustics_->shared(seen[i].hit) : SharedWithPhotons{};
    extendAll(*bsdf[i], throughput, learned, shared, points, s.rng, s.radiance);
  }
  if (pixelControl_) pixelControl_->apply(tile, seen);
  for (size_t i = 0; caustics_ && i < count; ++i) {
    const auto pixel = static_cast<uint32_t>(i % tile.pixels);
    tile.samples[i].radiance.indirect +=
        caustics_->at(tile.x + pixel % tile.width, tile.y + pixel / tile.width);
  }
  if (directSamples_) {
    constexpr unsigned kRaysOfExtension = 4;  // itself, and what it finds is lit
    directSamples_->render(tile, learned.strata, kRaysOfExtension * extensions_);
  }
}

Vec3 VplIntegrator::directAt(const Bsdf& bsdf, const LearnedLight& learned, const Points& points,
                             Rng& rng) const {
  if (!learned.strata) {
    return directLight(rays_, lights_, bsdf, LobeGroup::Rough, LightChoice::Each, extensions_, rng);
  }
  return directLight(rays_, lights_, bsdf, LobeGroup::Rough, learned, extensions_,
                     points.slot * lightRays_, points.lights);
}

void VplIntegrator::gatherTile(const TileSamples& tile, std::span<const SpecularPath> seen,
                               std::span<const Bsdf* const> bsdf) const {
  std::vector<Gathered> gathered(bsdf.size());
  gather_.tile({tile, bsdf}, gathered);
  for (size_t i = 0; i < gathered.size(); ++i) {
    RadianceSample& out = tile.samples[i].radiance;
    out.indirect += seen[i].throughput * gathered[i].radiance;
    out.clamped += seen[i].throughput * gathered[i].clamped;
    out.cut += gathered[i].cut;
    out.shadowRays += gathered[i].shadowRays;
  }
}

// The first link of a near-field ray.
struct VplIntegrator::Extension {
  Vec3 direction, throughput;
  Arrival arrival;
  const SurfacePoint* hit;
  const ReachGrid::Lookup* near;  // the VPLs there
};

// Rays from a sample's point wait for memory together.
void VplIntegrator::extendAll(const Bsdf& from, Vec3 throughput, const LearnedLight& learned,
                              const SharedWithPhotons& shared, const Points& points, Rng& rng,
                              RadianceSample& out) const {
  constexpr size_t kBatch = RayScene::kBatch;
  std::array<Ray, kBatch> rays;
  std::array<SurfacePoint, kBatch> hits;
  std::array<ReachGrid::Lookup, kBatch> near;
  std::array<Extension, kBatch> made;
  for (unsigned begin = 0, end; begin < extensions_; begin = end) {
    end = begin + std::min(extensions_ - begin, unsigned{kBatch});
    size_t count = 0;
    for (unsigned k = begin; k < end; ++k) {
      BsdfSample next;
      const float pick = rng.next();
      if (!from.sample(LobeGroup::Rough, Transport::Radiance, pick,
                       owenSobol(points.slot * extensions_ + k, points.directions), next)) {
        continue;
      }
      const Vec3 position = from.point().position;
      const auto all = static_cast<float>(extensions_);
      rays[count] = rayOn(rays_, from.point(), next);
      made[count] = {next.wi,
                     throughput * next.weight * (1.0f / all),
                     {next.pdf * all, position, LightChoice::Each, learned, shared},
                     &hits[count],
                     &near[count]};
      ++count;
    }
    rays_.closestHits({rays.data(), count}, hits);
    if (compensation_ && only_ != Only::Direct) {
      compensation_.lookUp({hits.data(), count}, near);
    }
    for (size_t k = 0; k < count; ++k) extend(made[k], rng, out);
  }
}

// One ray for the light over a mirror, glass or sharp lobe (VPLs shine in straight lines), and for
// what Compensation says is missing: from the scattered light that a VPL knows where it speaks for
// the point that the ray found, else by lighting that point as the first one, and so on. A light
// that it meets is the other half of the MIS of light sampling. All else is left to the VPLs.
void VplIntegrator::extend(const Extension& start, Rng& rng, RadianceSample& out) const {
  Vec3 throughput = start.throughput;
  LearnedStrata strata;
  SpecularPath end =
      followSpecularPath(rays_, lights_, *start.hit, start.direction, start.arrival, rng);
  for (unsigned links = 1;; ++links) {
    const bool first = links == 1;
    if (first && only_ != Only::Indirect) out.direct += throughput * end.metFirst;
    if (only_ == Only::Direct) return;
    Vec3 light = throughput * (end.metLater + (first ? Vec3{} : end.metFirst));
    const Missing missing = missingFrom(end, first ? start.near : nullptr, rng);
    throughput *= end.throughput;
    // Where a VPL knows the scattered light the path ends, so nothing shares the first-bounce light
    // with the shadow ray. Else it goes on, by roulette at full weight.
    const bool known = missing.scattered.has_value();
    const bool lit = known ? missing.share > 0.0f : rng.next() < missing.share;
    if (!lit) {
      out.compensated += light;
      out.indirect += light;
      return;
    }
    const Bsdf found(rays_.scene(), end.hit);
    if (surfaceLights_) strata = surfaceLights_->at(end.hit.position, end.hit.ng);
    const Vec3 leaving =
        directLight(rays_, lights_, found, LobeGroup::Rough, strata, known ? 0 : 1, rng);
    if (known) {
      light += throughput * (leaving + *missing.scattered) * missing.share;
    } else {
      const Gathered g = gather_.point(found, first ? kFirstDraws : kLaterDraws, rng);
      light += throughput * (leaving + g.radiance);
      out.clamped += throughput * g.clamped;
      out.shadowRays += g.shadowRays;
    }
    out.compensated += light;
    out.indirect += light;
    BsdfSample sample;
    Ray next;
    if (known || links == kMaxExtensions ||
        !scatter(rays_, found, LobeGroup::Rough, Transport::Radiance, rng, sample, next)) {
      return;
    }
    throughput *= sample.weight;
    end = followSpecularPath(rays_, lights_, next.origin, next.direction,
                             {sample.pdf, end.hit.position, LightChoice::One, learnedBy(strata)},
                             rng);
  }
}

// `near`: of the hit, where that is the first; null: to be looked up.
Missing VplIntegrator::missingFrom(const SpecularPath& end, const ReachGrid::Lookup* near,
                                   Rng& rng) const {
  if (!end.rough) return {};
  if (end.links > 0) return {1.0f, {}};
  if (!compensation_) return {};
  return compensation_.missing(end.hit, end.hit.distance, near, rng);
}

}  // namespace bnvpl
