#include "tools/render/integrator/vpl/near_field_rays.h"

#include <array>
#include <cmath>

#include "transport/walk.h"

namespace bnvpl {

namespace {

// Vertices beyond the first that a near-field ray may add; each follows with the missing share
// alone.
constexpr unsigned kMaxExtensions = 16;
// VPLs that light what a near-field ray found, which has more noise of its own the further it is
// down the path (measured: docs/theory.md, "Near field").
constexpr unsigned kFirstDraws = 8, kLaterDraws = 2;
// Shadow rays to lights from the first such point.
constexpr unsigned kFirstLightRays = 4;
// What rough lobes that VPLs bring are taken to be worth all the same: rays that go on cost more.
constexpr float kLeastWorth = 0.1f;
// In units of cost:: (measured: theory.md).
constexpr double kCostOfRay = 16.0;

}  // namespace

double NearFieldRays::costOfRay() const { return kCostOfRay; }

void NearFieldRays::send(const RaysFrom& from, unsigned count, uint32_t first, uint64_t key,
                         RaysBrought& out) const {
  std::array<ReachGrid::Lookup, RayScene::kBatch> near;
  sendRays(
      rays_, from, shares_, count, first, key, out,
      [&](std::span<const SurfacePoint> hits) {
        if (compensation_ && only_ != Only::Direct) compensation_.lookUp(hits, near);
      },
      [&](size_t k, const FirstLink& link) { follow(link, near[k], from.shares, out); });
}

// One ray for the light over a mirror, glass or sharp lobe (VPLs shine in straight lines), and for
// what Compensation says is missing: either from the scattered light that a VPL knows where it
// speaks for the point that the ray found, or else by lighting that point as the first one, and so
// on. A light that it meets is the other half of the MIS of light sampling. All else is left to the
// VPLs.
void NearFieldRays::follow(const FirstLink& start, const ReachGrid::Lookup& near, bool share,
                           RaysBrought& out) const {
  Rng rng = start.rng;
  Vec3 throughput = start.throughput;
  // From a hit that others share `throughput` is counted anew.
  SharedHit hit;
  bool shared = false;
  float factor = 0.0f;  // of its RoughLeaving, towards this ray
  const auto add = [&](Vec3 light) {
    if (shared) {
      hit.radiance += light;
      light = start.throughput * light;
      out.ofHits += light;
    }
    out.compensated += light;
    out.indirect += light;
  };
  const auto done = [&] {
    if (!shared) return;
    hit.radiance *= 1.0f / factor;
    out.hits.push_back(hit);
  };
  LearnedStrata strata;
  // What VPLs bring of the first hit's rough lobes, rays need not: they take the specular ones.
  std::optional<Missing> atFirst;
  if (start.hit->triangle != kNone && only_ != Only::Direct &&
      mayBeSpecular(rays_.scene().materials[start.hit->material]))
    atFirst = missingFrom(*start.hit, true, &near, rng);
  const float roughWorth = atFirst ? std::max(kLeastWorth, atFirst->share) : 1.0f;
  SpecularPath end = followSpecularPath(rays_, lights_, *start.hit, start.direction, start.arrival,
                                        rng, {nullptr, surfaceLights_}, roughWorth);
  for (unsigned links = 1;; ++links) {
    const bool first = links == 1;
    if (first && only_ != Only::Indirect) out.direct += throughput * end.metFirst;
    if (only_ == Only::Direct) return done();
    Vec3 light = throughput * (end.metLater + (first ? Vec3{} : end.metFirst));
    const bool straight = end.links == 0;
    const bool atFirstHit = first && straight;
    const bool chosen = atFirstHit && atFirst;  // lobes, by their worth
    const Missing missing = !end.rough ? Missing{}
                            : chosen
                                ? *atFirst
                                : missingFrom(end.hit, straight, atFirstHit ? &near : nullptr, rng);
    throughput *= end.throughput;
    if (!(missing.share > 0.0f)) {
      add(light);
      return done();
    }
    const Bsdf found(rays_.scene(), end.hit);
    // Where a VPL knows the scattered light the path ends, so nothing shares the first-bounce light
    // with the shadow ray. Else it goes on, by roulette at full weight.
    const bool known = missing.scattered.has_value();
    float chance = missing.share;
    if (chosen && !known) {
      // Part of the roulette was the choice of lobes.
      const float specular = found.specularProbability();
      chance *= (specular + (1.0f - specular) * roughWorth) / roughWorth;
      end.throughput *= missing.share / chance;
      throughput *= missing.share / chance;
    }
    if (!known && rng.next() >= chance) {
      add(light);
      return done();
    }
    if (share && first && missing.own.within > 0.0f && straight) {
      const std::optional<RoughLeaving> matt = found.roughLeaving();
      factor = matt ? matt->towards(end.hit.wo) : 0.0f;
      if (factor > 0.0f) {
        add(light);
        hit = {end.hit.position, end.hit.ng, *matt, {}, missing.own};
        shared = true;
        light = {}, throughput = end.throughput;
      }
    }
    if (surfaceLights_) strata = surfaceLights_->at(end.hit.position, end.hit.ng);
    const LearnedLight lights{strata.all ? &strata : nullptr,
                              first && !(known && straight) ? kFirstLightRays : 1};
    const Vec3 leaving =
        lights.strata && lights.rays > 1
            ? directLight(rays_, lights_, found, LobeGroup::Rough, lights, known ? 0.0f : 1.0f, 0,
                          mix64(static_cast<uint64_t>(rng.next() * 0x1p24f)))
            : directLight(rays_, lights_, found, LobeGroup::Rough, strata, known ? 0.0f : 1.0f,
                          rng);
    if (known) {
      light += throughput * (leaving + *missing.scattered) * missing.share;
    } else {
      const Gathered g = point_(found, first ? kFirstDraws : kLaterDraws, rng);
      light += throughput * (leaving + g.radiance);
      out.clamped += shared ? start.throughput * throughput * g.clamped : throughput * g.clamped;
      out.shadowRays += g.shadowRays;
    }
    add(light);
    BsdfSample sample;
    Ray next;
    if (known || links == kMaxExtensions ||
        !scatter(rays_, found, LobeGroup::Rough, Transport::Radiance, rng, sample, next)) {
      return done();
    }
    throughput *= sample.weight;
    end = followSpecularPath(rays_, lights_, next.origin, next.direction,
                             {sample.pdf, end.hit.position, LightChoice::One, lights}, rng,
                             {nullptr, surfaceLights_});
  }
}

// From a rough vertex, straight on or over specular ones. `near`: of it, where that is the first;
// null: to be looked up.
Missing NearFieldRays::missingFrom(const SurfacePoint& hit, bool straight,
                                   const ReachGrid::Lookup* near, Rng& rng) const {
  if (!compensation_) return {straight ? 0.0f : 1.0f, {}};
  Missing missing = compensation_.missing(hit, hit.distance, near, rng);
  // Over specular vertices VPLs bring nothing, but know the light all the same.
  if (!straight) missing = {1.0f, missing.scattered};
  return missing;
}

}  // namespace bnvpl
