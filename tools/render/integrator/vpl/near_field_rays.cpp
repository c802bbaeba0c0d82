#include "tools/render/integrator/vpl/near_field_rays.h"

#include <array>
#include <cmath>

#include "transport/walk.h"

namespace bnvpl {

namespace {

// A path goes on with the probability of the uncovered share, so most paths end soon. From
// kSureSegments segments on, Russian roulette by the scattering weight ends paths, too.
// kMaxSegments bounds what neither ends.
constexpr unsigned kSureSegments = 16, kMaxSegments = 256;
// Number of VPLs sampled at a vertex: few, and fewer at later vertices, whose noise matters less
// (measured).
constexpr unsigned kFirstDraws = 8, kLaterDraws = 2;
// Shadow rays to lights from the first vertex.
constexpr unsigned kFirstLightRays = 4;
// Minimal importance of rough lobes whose light VPLs carry.
constexpr float kMinImportance = 0.1f;
// Cost of a ray in the units of cost:: (measured: tools/render/tile/theory.md).
constexpr double kCostOfRay = 16.0;

}  // namespace

double NearFieldRays::costOfRay() const { return kCostOfRay; }
float NearFieldRays::roughImportance() const { return kMinImportance; }

void NearFieldRays::send(const RayOrigin& from, unsigned count, uint32_t first, uint64_t key,
                         RayContributions& out) const {
  std::array<ReachGrid::Lookup, Accelerator::kBatch> coverLookup;
  std::vector<Vec3> groups(2 * size_t{out.groups});
  sendRays(
      accel_, from, count, first, key, out,
      [&](std::span<const SurfacePoint> hits) {
        if (compensation_.byRays() && shown_ != ShownLight::Direct)
          compensation_.lookUp(hits, coverLookup);
      },
      [&](size_t k, const FirstSegment& segment) {
        follow(segment, coverLookup[k], from.reuse, groups, out);
      });
}

// A path from a shading point. A segment leads from a rough vertex over specular vertices to the
// next rough one.
struct NearFieldRays::Path {
  const FirstSegment& start;
  RayContributions& out;
  Rng rng;
  Vec3 throughput;  // from the camera, or once the path has a reused vertex, from there
  SpecularPath segment = {};
  unsigned segments = 1;
  Vec3 light = {};  // found, but not added yet
  LearnedStrata strata = {};
  // Set where the first hit offers specular and rough lobes: the uncovered share decided how often
  // the path took the rough ones.
  std::optional<Uncovered> atFirstHit = {};
  float roughImportance = 1.0f;
  std::optional<ReusedVertex> reused = {};
  float towardsStart = 0.0f;  // factor of its ExitantFactor
  // The same of each light group: `light`, and the radiance of the reused vertex.
  std::span<Vec3> lightGroups = {}, vertexGroups = {};

  bool isFirst() const { return segments == 1; }
  bool isStraight() const { return segment.specularBounces == 0; }
  bool choseLobes() const { return isFirst() && isStraight() && atFirstHit; }

  LearnedLight learned(unsigned rays) const { return {strata.all ? &strata : nullptr, rays}; }

  LightGroupSink lightSink() const { return sinkTo(lightGroups); }
  void addGroups() {
    for (uint32_t g = 0; g < lightGroups.size(); ++g) {
      Vec3 found = lightGroups[g];
      if (reused) {
        vertexGroups[g] += found;
        found = start.throughput * found;
        out.vertexLightGroups().add(g, found);
      }
      out.indirectGroups().add(g, found);
      lightGroups[g] = {};
    }
  }
  void addLight() {
    addGroups();
    if (isBlack(light)) return;
    if (reused) {
      reused->radiance += light;
      light = start.throughput * light;
      out.vertexLight += light;
    }
    out.compensated += light;
    out.indirect += light;
    light = {};
  }
  // From here on the path finds the radiance that leaves its first vertex, for its own sample and
  // for those that reuse the vertex.
  void makeReusable(const Uncovered& uncovered, const Bsdf& bsdf) {
    if (!isFirst() || !isStraight() || !(uncovered.byDistance.within > 0.0f)) return;
    const std::optional<ExitantFactor> leaving = bsdf.exitantFactor();
    towardsStart = leaving ? leaving->towards(segment.hit.wo) : 0.0f;
    if (!(towardsStart > 0.0f)) return;
    addLight();
    reused = {segment.hit.position, segment.hit.ng, *leaving, {}, uncovered.byDistance};
    throughput = segment.throughput;
  }
  void finish() {
    if (!reused) return;
    reused->radiance *= 1.0f / towardsStart;
    for (const Vec3 v : vertexGroups) out.vertexGroups.push_back(v * (1.0f / towardsStart));
    out.vertices.push_back(*reused);
  }
};

// Estimates the light that a ray adds to the VPLs' light. Emission that a segment hits has its MIS
// weight against light sampling. At a rough vertex the path
//   - ends where VPLs carry all of its light (uncovered share 0);
//   - weights the vertex by the uncovered share and ends there, if a VPL knows the radiance that
//     leaves it; only the first-bounce light is sampled anew, by shadow rays;
//   - otherwise survives with the probability of the uncovered share, is lit like a shading point
//     by lights and VPLs, and goes on in a direction sampled from the BSDF.
void NearFieldRays::follow(const FirstSegment& start, const ReachGrid::Lookup& coverLookup,
                           bool reuse, std::span<Vec3> groups, RayContributions& out) const {
  Path path{start, out, start.rng, start.throughput};
  std::ranges::fill(groups, Vec3{});
  path.lightGroups = groups.first(out.groups), path.vertexGroups = groups.last(out.groups);
  begin(path, coverLookup);
  for (bool goesOn = true; goesOn; ++path.segments) {
    const SpecularPath& segment = path.segment;
    const bool first = path.isFirst();
    if (first && shown_ != ShownLight::Indirect)
      out.direct += path.throughput * segment.firstSegmentEmission;
    if (shown_ == ShownLight::Direct) break;
    path.light = path.throughput *
                 (segment.lightOverSpecular + (first ? Vec3{} : segment.firstSegmentEmission));
    Uncovered uncovered;
    if (path.choseLobes() && segment.rough) {
      uncovered = *path.atFirstHit;
    } else if (segment.rough) {
      uncovered = uncoveredAt(segment.hit, path.isStraight(),
                              first && path.isStraight() ? &coverLookup : nullptr, path.rng);
    }
    path.throughput *= segment.throughput;
    goesOn = uncovered.share > 0.0f;
    if (goesOn) {
      const Bsdf bsdf(accel_.scene(), segment.hit);
      goesOn = passesRoulette(path, uncovered, bsdf);
      if (goesOn) {
        if (reuse) path.makeReusable(uncovered, bsdf);
        shade(path, uncovered, bsdf);
        path.addLight();
        goesOn = !uncovered.multiBounceRadiance && extend(path, bsdf);
      }
    }
    path.addLight();
  }
  path.finish();
}

// Follows the first segment. Where VPLs carry a part of the light that rough lobes would find, the
// path takes specular lobes more often.
void NearFieldRays::begin(Path& path, const ReachGrid::Lookup& coverLookup) const {
  const SurfacePoint& hit = *path.start.hit;
  if (hit.triangle != kNone && shown_ != ShownLight::Direct &&
      mayBeSpecular(accel_.scene().materials[hit.material])) {
    path.atFirstHit = uncoveredAt(hit, true, &coverLookup, path.rng);
    path.roughImportance = std::max(kMinImportance, path.atFirstHit->share);
  }
  SpecularLightSampling sampling{nullptr, spatialLights_};
  if (shown_ != ShownLight::Indirect)
    sampling.firstSegmentEmission = path.out.directGroups().times(path.throughput);
  if (shown_ != ShownLight::Direct)
    sampling.lightOverSpecular = path.lightSink().times(path.throughput);
  path.segment = followSpecularPath(accel_, lights_, hit, path.start.direction, path.start.arrival,
                                    path.rng, sampling, path.roughImportance);
}

// `straight`: the segment passed no specular vertex. `coverLookup`: the VPLs at the hit; null: not
// looked up yet.
Uncovered NearFieldRays::uncoveredAt(const SurfacePoint& hit, bool straight,
                                     const ReachGrid::Lookup* coverLookup, Rng& rng) const {
  if (!compensation_.byRays()) return {straight ? 0.0f : 1.0f, {}};
  Uncovered out = compensation_.uncovered(hit, hit.distance, coverLookup, rng);
  // No VPL carries light over specular vertices, so the share is 1. The mean radiance that a VPL
  // knows holds at the hit as elsewhere.
  if (!straight) out.share = 1.0f, out.byDistance = {};
  return out;
}

// Russian roulette by the uncovered share s, unless a VPL knows the radiance: then s is a weight in
// shade(). A path that chose lobes at its first hit took the rough ones with the probability
// (1 - q) w / Q, where q = specularProbability(), w = roughImportance and Q = q + (1 - q) w, and
// carries the inverse. It goes on with s Q / w, which makes (1 - q) s, and is multiplied by w / Q,
// which leaves the weight 1 / (1 - q). Both throughputs get this factor: the path's, and that of
// the segment, from which makeReusable() begins anew.
bool NearFieldRays::passesRoulette(Path& path, const Uncovered& uncovered, const Bsdf& bsdf) const {
  if (uncovered.multiBounceRadiance) return true;
  float probability = uncovered.share;
  if (path.choseLobes()) {
    const float specular = bsdf.specularProbability();
    probability *= (specular + (1.0f - specular) * path.roughImportance) / path.roughImportance;
    path.segment.throughput *= uncovered.share / probability;
    path.throughput *= uncovered.share / probability;
  }
  return path.rng.next() < probability;
}

// Adds first-bounce light by shadow rays, and further light as a VPL knows it or from all VPLs. If
// the path will be extended, the shadow rays have MIS weights against the next segment's ray.
void NearFieldRays::shade(Path& path, const Uncovered& uncovered, const Bsdf& bsdf) const {
  const bool known = uncovered.multiBounceRadiance.has_value(), first = path.isFirst();
  const SurfacePoint& hit = path.segment.hit;
  if (spatialLights_) path.strata = spatialLights_->at(hit.position, hit.ng);
  const LearnedLight lights =
      path.learned(first && !(known && path.isStraight()) ? kFirstLightRays : 1);
  const float bsdfRays = known ? 0.0f : 1.0f;
  const LightNumbers numbers =
      lights.strata && lights.rays > 1 ? LightNumbers::sequence(path.rng) : LightNumbers(path.rng);
  const LightGroupSink groups =
      path.lightSink().times(path.throughput * (known ? uncovered.share : 1.0f));
  const Vec3 firstBounce =
      directLight(accel_, lights_, Reflected{bsdf}, {lights, LightChoice::One, {}, groups},
                  BsdfRays{bsdf, bsdfRays}, numbers);
  if (known) {
    path.light +=
        path.throughput * (firstBounce + *uncovered.multiBounceRadiance) * uncovered.share;
    for (uint32_t g = 0; g < path.lightGroups.size(); ++g)
      groups.add(g, uncovered.multiBounceFlux[g] * uncovered.perFlux);
    return;
  }
  const Gathered vpls = gatherAt_(bsdf, first ? kFirstDraws : kLaterDraws, path.rng, groups);
  path.light += path.throughput * (firstBounce + vpls.radiance);
  path.out.clamped += path.reused ? path.start.throughput * path.throughput * vpls.clamped
                                  : path.throughput * vpls.clamped;
  path.out.shadowRays += vpls.shadowRays;
}

// Returns false if the path is absorbed or has its maximal length.
bool NearFieldRays::extend(Path& path, const Bsdf& bsdf) const {
  BsdfSample sample;
  Ray next;
  if (path.segments == kMaxSegments ||
      !sampleNextRay(accel_, bsdf, LobeGroup::Rough, TransportMode::Radiance, path.rng, sample,
                     next)) {
    return false;
  }
  if (path.segments >= kSureSegments) {
    const float survival = rouletteSurvival(sample);
    if (!(path.rng.next() < survival)) return false;
    sample.weight *= 1.0f / survival;
  }
  ++path.out.continued;
  path.throughput *= sample.weight;
  const LightGroupSink groups = path.lightSink().times(path.throughput);
  const LearnedLight lights = path.learned(path.isFirst() ? kFirstLightRays : 1);
  path.segment =
      followSpecularPath(accel_, lights_, next.origin, next.direction,
                         {sample.pdf, path.segment.hit.position, LightChoice::One, lights},
                         path.rng, {nullptr, spatialLights_, groups, groups});
  return true;
}

}  // namespace bnvpl
