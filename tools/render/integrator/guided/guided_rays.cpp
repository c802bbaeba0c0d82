#include "tools/render/integrator/guided/guided_rays.h"

#include <algorithm>
#include <optional>

#include "transport/walk.h"

namespace bnvpl {

namespace {

// Paths go on for sure where they will bring half of what the first vertex shows. Ending more of
// them takes less time and adds more noise.
constexpr float kEager = 3.0f;
// What the guide calls dark may not be: what is found there counts at most three times.
constexpr float kLeastSurvival = 0.4f;
// Shadow rays to lights from what a ray has found, which many samples share.
constexpr unsigned kFirstLightRays = 2;
// In units of cost:: (measured: theory.md).
constexpr double kCostOfRay = 30.0;

}  // namespace

double GuidedRays::costOfRay() const { return kCostOfRay; }

void GuidedRays::send(const RaysFrom& from, unsigned count, uint32_t first, uint64_t key,
                      RaysBrought& out) const {
  const Bsdf& bsdf = from.directions.bsdf();
  const uint32_t region = guide_.regionAt(bsdf.point());
  const float shown = guide_.knows(region)
                          ? mean(from.throughput) * mean(bsdf.roughAlbedo()) *
                                std::max(guide_.total(region), guide_.onward(region))
                          : 0.0f;
  sendRays(
      rays_, from, raysEach_, count, first, key, out, [](std::span<const SurfacePoint>) {},
      [&](size_t, const FirstLink& link) { follow(link, shown, from.shares, out); });
}

// Path tracing from what the ray hits on. Others share the light that leaves there in all
// directions alike: all of it where the surface is matt, or else by its matt part. The rest is this
// ray's own.
void GuidedRays::follow(const FirstLink& start, float shown, bool share, RaysBrought& out) const {
  Rng rng = start.rng;
  SpecularPath vertex = followSpecularPath(rays_, lights_, *start.hit, start.direction,
                                           start.arrival, rng, {nullptr, &where_});
  if (only_ != Only::Indirect) out.direct += start.throughput * vertex.metFirst;
  if (only_ == Only::Direct) return;
  const auto add = [&](Vec3 light) { out.indirect += light, out.compensated += light; };
  add(start.throughput * vertex.metLater);
  if (maxBounces_ == 0 || !vertex.rough) return;

  const Bsdf first(rays_.scene(), vertex.hit);
  SharedHit hit{vertex.hit.position, vertex.hit.ng, {}, {}, OwnLight{INFINITY, INFINITY, {}}};
  Vec3 matt;
  float factor = 0.0f;
  if (share && vertex.links == 0) {
    const std::optional<RoughLeaving> all = first.roughLeaving();
    const MattPart part = first.mattPart();
    hit.leaving = all.value_or(part.leaving);
    if (!all) matt = part.value;
    factor = all || !isBlack(matt) ? hit.leaving.towards(vertex.hit.wo) : 0.0f;
    if (factor == 0.0f) matt = {};
  }
  const LightWithPart leaving = lightFrom(first, start, shown, vertex.throughput, matt, rng);
  add(start.throughput * leaving.all);
  if (factor == 0.0f) return;
  const Vec3 shared = isBlack(matt) ? leaving.all : leaving.part;
  out.ofHits += start.throughput * shared;
  hit.radiance = shared * (1.0f / factor);
  out.hits.push_back(hit);
}

// Light that leaves the first vertex of a ray, by all and by a matt part of what scatters there,
// times `throughput`.
LightWithPart GuidedRays::lightFrom(const Bsdf& first, const FirstLink& start, float shown,
                                    Vec3 throughput, Vec3 matt, Rng& rng) const {
  LightWithPart leaving, weight{throughput, throughput};
  SpecularPath vertex;
  std::optional<Bsdf> scattering;
  LearnedStrata strata;
  for (unsigned bounce = 1;; ++bounce) {
    const Bsdf& bsdf = bounce == 1 ? first : scattering.emplace(rays_.scene(), vertex.hit);
    const uint32_t region = guide_.regionAt(bsdf.point());
    const Directions directions = directionsIn(region, bsdf);
    strata = where_.at(bsdf.point().position, bsdf.point().ng);
    const LearnedLight lights{strata.all ? &strata : nullptr, bounce == 1 ? kFirstLightRays : 1};
    const auto rayPdf = [&](Vec3 wi) { return directions.pdf(wi); };
    if (bounce == 1) {
      leaving += directLight(rays_, lights_, bsdf, LobeGroup::Rough, matt, lights, rayPdf, rng) *
                 throughput;
    } else {
      const Vec3 light = directLight(rays_, lights_, bsdf, LobeGroup::Rough, lights, rayPdf, rng);
      leaving += weight * light;
    }

    float survive = bsdf.reflectance();
    if (shown > 0.0f && guide_.knows(region)) {
      const float brings =
          mean(start.throughput * weight.all) * mean(bsdf.roughAlbedo()) * guide_.onward(region);
      survive = std::clamp(kEager * brings / shown, kLeastSurvival, 1.0f);
    }
    BsdfSample scattered;
    if (rng.next() >= survive || !directions.sample(rng, scattered)) break;
    if (bounce == 1)
      weight.part *= matt * (mattCosine(bsdf.point(), scattered.wi) / (scattered.pdf * survive));
    else
      weight.part *= scattered.weight * (1.0f / survive);
    weight.all *= scattered.weight * (1.0f / survive);
    const Ray next = rayOn(rays_, bsdf.point(), scattered);
    vertex = followSpecularPath(rays_, lights_, next.origin, next.direction,
                                {scattered.pdf, bsdf.point().position, LightChoice::One, lights},
                                rng, {nullptr, &where_});
    leaving += weight * (vertex.metFirst + vertex.metLater);
    if (bounce == maxBounces_ || !vertex.rough) break;
    weight = weight * vertex.throughput;
  }
  return leaving;
}

}  // namespace bnvpl
