#include "tools/render/integrator/guided/guided_rays.h"

#include <algorithm>
#include <optional>

#include "transport/walk.h"

namespace bnvpl {

namespace {

// Russian roulette by expected contribution (Vorba & Krivanek 2016). A path survives for certain if
// it is expected to add a third of the shading point's radiance; ending more paths would save time
// and add more noise.
constexpr float kCertain = 3.0f;
// Minimal probability of survival, as the guide may be wrong about dark places.
constexpr float kMinSurvival = 0.4f;
// Shadow rays to lights from the first vertex, which many samples reuse.
constexpr unsigned kLightRaysFromFirst = 2;
// Cost of a ray in the units of cost:: (measured: tools/render/tile/theory.md).
constexpr double kCostOfGuidedRay = 30.0;

}  // namespace

double GuidedRays::costOfRay() const { return kCostOfGuidedRay; }

void GuidedRays::send(const RayOrigin& from, unsigned count, uint32_t first, uint64_t key,
                      RayContributions& out) const {
  const Bsdf& bsdf = from.directions.bsdf();
  const uint32_t region = guide_.regionAt(bsdf.point());
  const float expected = guide_.knows(region)
                             ? mean(from.throughput) * mean(bsdf.roughAlbedo()) *
                                   std::max(guide_.total(region), guide_.onward(region))
                             : 0.0f;
  std::vector<Vec3> groups(3 * size_t{out.groups});
  sendRays(
      accel_, from, count, first, key, out, [](std::span<const SurfacePoint>) {},
      [&](size_t, const FirstSegment& segment) {
        follow(segment, expected, from.reuse, groups, out);
      });
}

// Path tracing from the first hit on. Other samples reuse the light that leaves the first vertex
// alike in all directions: all of it if the surface is diffuse, or else that of its diffuse lobe.
// The rest belongs to this ray alone.
void GuidedRays::follow(const FirstSegment& start, float expected, bool reuse,
                        std::span<Vec3> groups, RayContributions& out) const {
  Rng rng = start.rng;
  SpecularLightSampling sampling{nullptr, &spatialLights_};
  if (shown_ != ShownLight::Indirect)
    sampling.firstSegmentEmission = out.directGroups().times(start.throughput);
  if (shown_ != ShownLight::Direct)
    sampling.lightOverSpecular = out.indirectGroups().times(start.throughput);
  SpecularPath vertex = followSpecularPath(accel_, lights_, *start.hit, start.direction,
                                           start.arrival, rng, sampling);
  if (shown_ != ShownLight::Indirect) out.direct += start.throughput * vertex.firstSegmentEmission;
  if (shown_ == ShownLight::Direct) return;
  const auto add = [&](Vec3 light) { out.indirect += light, out.compensated += light; };
  add(start.throughput * vertex.lightOverSpecular);
  if (maxBounces_ == 0 || !vertex.rough) return;

  const Bsdf first(accel_.scene(), vertex.hit);
  ReusedVertex reused{
      vertex.hit.position, vertex.hit.ng, {}, {}, UncoveredShare{INFINITY, INFINITY, {}}};
  Vec3 diffuse;
  float towardsStart = 0.0f;  // factor of ExitantFactor
  if (reuse && vertex.specularBounces == 0) {
    const std::optional<ExitantFactor> all = first.exitantFactor();
    const DiffusePart part = first.diffusePart();
    reused.leaving = all.value_or(part.leaving);
    if (!all) diffuse = part.value;
    towardsStart = all || !isBlack(diffuse) ? reused.leaving.towards(vertex.hit.wo) : 0.0f;
    if (towardsStart == 0.0f) diffuse = {};
  }
  std::ranges::fill(groups, Vec3{});
  const LightWithPart leaving =
      tracePath(first, start, expected, vertex.throughput, diffuse, rng, groups);
  add(start.throughput * leaving.all);
  for (uint32_t g = 0; g < out.groups; ++g)
    out.indirectGroups().add(g, start.throughput * groups[g]);
  if (towardsStart == 0.0f) return;
  const Vec3 shared = isBlack(diffuse) ? leaving.all : leaving.part;
  out.vertexLight += start.throughput * shared;
  reused.radiance = shared * (1.0f / towardsStart);
  out.vertices.push_back(reused);
  for (uint32_t g = 0; g < out.groups; ++g) {
    const Vec3 light = groups[isBlack(diffuse) ? g : out.groups + g];
    out.vertexLightGroups().add(g, start.throughput * light);
    out.vertexGroups.push_back(light * (1.0f / towardsStart));
  }
}

// Light that leaves the first vertex of a ray, and the part of it that the lobe `diffuse` scatters,
// both times `throughput`. `groups` receives both by light group; its last third is scratch.
LightWithPart GuidedRays::tracePath(const Bsdf& first, const FirstSegment& start, float expected,
                                    Vec3 throughput, Vec3 diffuse, Rng& rng,
                                    std::span<Vec3> groups) const {
  const size_t lightGroups = groups.size() / 3;
  const LightGroupSink all = sinkTo(groups.first(lightGroups)),
                       part = sinkTo(groups.subspan(lightGroups, lightGroups));
  const std::span<Vec3> emission = groups.last(lightGroups);
  const auto sinks = [&](const LearnedLight& lights, const LightWithPart& w) {
    return LightSampling{lights, LightChoice::One, {}, all.times(w.all), part.times(w.part)};
  };
  LightWithPart leaving, weight{throughput, throughput};
  SpecularPath vertex;
  std::optional<Bsdf> scattering;
  LearnedStrata strata;
  for (unsigned bounce = 1;; ++bounce) {
    const Bsdf& bsdf = bounce == 1 ? first : scattering.emplace(accel_.scene(), vertex.hit);
    const uint32_t region = guide_.regionAt(bsdf.point());
    const Directions directions = directionsIn(region, bsdf);
    strata = spatialLights_.at(bsdf.point().position, bsdf.point().ng);
    const LearnedLight lights{strata.all ? &strata : nullptr,
                              bounce == 1 ? kLightRaysFromFirst : 1};
    const auto rayPdf = [&](Vec3 wi) { return directions.pdf(wi); };
    const LightNumbers numbers = lights.strata ? LightNumbers::sequence(rng) : LightNumbers(rng);
    if (bounce == 1) {
      const ReflectedWithDiffuse reflected{bsdf, diffuse};
      leaving += directLight(accel_, lights_, reflected, sinks(lights, weight), rayPdf, numbers) *
                 throughput;
    } else {
      leaving += weight * directLight(accel_, lights_, Reflected{bsdf}, sinks(lights, weight),
                                      rayPdf, numbers);
    }

    float survival = bsdf.survivalProbability();
    if (expected > 0.0f && guide_.knows(region)) {
      const float contribution =
          mean(start.throughput * weight.all) * mean(bsdf.roughAlbedo()) * guide_.onward(region);
      survival = std::clamp(kCertain * contribution / expected, kMinSurvival, 1.0f);
    }
    BsdfSample next;
    if (rng.next() >= survival || !directions.sample(rng, next)) break;
    if (bounce == 1)
      weight.part *= diffuse * (diffuseCosine(bsdf.point(), next.wi) / (next.pdf * survival));
    else
      weight.part *= next.weight * (1.0f / survival);
    weight.all *= next.weight * (1.0f / survival);
    const Ray ray = spawnRay(accel_, bsdf.point(), next);
    vertex = followSpecularPath(accel_, lights_, ray.origin, ray.direction,
                                {next.pdf, bsdf.point().position, LightChoice::One, lights}, rng,
                                {nullptr, &spatialLights_, sinkTo(emission), sinkTo(emission)});
    leaving += weight * (vertex.firstSegmentEmission + vertex.lightOverSpecular);
    for (uint32_t g = 0; g < lightGroups; ++g) {
      all.times(weight.all).add(g, emission[g]);
      part.times(weight.part).add(g, emission[g]);
      emission[g] = {};
    }
    if (bounce == maxBounces_ || !vertex.rough) break;
    weight = weight * vertex.throughput;
  }
  return leaving;
}

}  // namespace bnvpl
