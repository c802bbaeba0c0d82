#include "tools/render/compensate/near_field/near_field.h"

#include <memory>

#include "core/parallel.h"
#include "core/random.h"
#include "core/sampling.h"
#include "tools/common/streams.h"
#include "transport/direct_light.h"

namespace bnvpl {

namespace {

// VPLs that were placed from the lights stand for all surfaces by chance, without a reach of their
// own.
constexpr float kReachWithoutPhotons = 2.0f;
// Points of a VPL's disk that its area is measured with: as many as find its surface so often.
// Where the last still fall short there are slivers, whose area, and so whose radiance, is not
// known.
constexpr uint32_t kAreaPoints = 32, kMaxAreaPoints = 256, kMinFound = 8;
// A ray shorter than this many r_max has found a crevice or a corner, where the light differs from
// the mean of the VPL's surroundings: the point's own light is found out instead (measured:
// docs/theory.md, "Near field").
constexpr float kShortRay = 0.7f;
// Points of a VPL's surface, rays from each of them, and from where it shines as many as from all.
constexpr uint32_t kGainPoints = 32, kGainRays = 4;
// In a crevice VPLs bring next to nothing, and how much less than elsewhere is not known well.
constexpr double kLeastBrought = 0.05;
constexpr float kUnknown = -1.0f;  // area that nobody has asked for

std::vector<float> scaled(std::vector<float> values, float factor) {
  for (float& v : values) v *= factor;
  return values;
}

// Area of the surface that VPL i speaks for, world units squared. 0: not known.
float areaOf(uint32_t i, const Coverage& coverage) {
  float sum = 0.0f;
  uint32_t points = 0, found = 0;
  for (; points < kAreaPoints || (found < kMinFound && points < kMaxAreaPoints); ++points) {
    const float before = sum;
    coverage.forEachLayer(i, r2Sequence(points, 0.5, 0.5),
                          [&](const SurfacePoint&, float area) { sum += area; });
    found += sum > before;
  }
  return found < kMinFound ? 0.0f : sum / static_cast<float>(points);
}

}  // namespace

NearField::NearField(const VplTable& lit, const RayScene& rays, float clamp, LightKind kind)
    : lit_(lit),
      rays_(rays),
      coverage_(lit.position, lit.normal,
                scaled(lit.radius,
                       lit.reach > 0.0 ? static_cast<float>(lit.reach) : kReachWithoutPhotons),
                rays),
      kind_(kind),
      clampRadius_(scaled(lit.radius, clamp)),
      area_(lit.size()),
      gaps_(lit.reach > 0.0) {
  for (std::atomic<float>& area : area_) area = kUnknown;
}

// Two threads may measure one area; both find the same.
float NearField::area(uint32_t vpl) const {
  float area = area_[vpl].load(std::memory_order_relaxed);
  if (area == kUnknown) {
    area = areaOf(vpl, coverage_);
    area_[vpl].store(area, std::memory_order_relaxed);
  }
  return area;
}

std::optional<Vec3> NearField::scatteredBy(uint32_t vpl) const {
  if (!gaps_) return {};  // the flux of a photon says nothing of the area around it
  const float known = area(vpl);
  if (!(known > 0.0f)) return {};
  return (lit_.flux[vpl] - lit_.firstBounceFlux[vpl]) * (1.0f / (kPi * known));
}

Missing NearField::missing(const SurfacePoint& seen, float distance, const ReachGrid::Lookup& near,
                           Rng& rng) const {
  const Coverage::Found found = coverage_.pick(seen.position, seen.ng, near, rng);
  if (!found.vpl) return {gaps_ ? 1.0f : 0.0f, {}};
  const float relative = distance / clampRadius_[*found.vpl];
  const float share = withKind(kind_, [&](auto k) { return k.removed(relative); });
  if (distance < kShortRay * lit_.radius[*found.vpl]) return {share, {}};
  return {share, scatteredBy(*found.vpl)};
}

NearField::Found NearField::look(uint32_t vpl, Vec3 at, Vec3 normal, Rng& rng) const {
  SurfacePoint hit;
  const float u = rng.next(), v = rng.next();
  const Vec3 d = Basis(normal).toWorld(sampleCosineHemisphere(u, v));
  if (!rays_.closestHit(rays_.offsetOrigin(at, normal), d, hit)) return {};
  const float relative = hit.distance / clampRadius_[vpl];
  Found found{1.0f - withKind(kind_, [&](auto k) { return k.removed(relative); })};
  const auto there = coverage_.pick(hit.position, hit.ng, coverage_.lookUp(hit.position), rng).vpl;
  if (there && area(*there) > 0.0f) found.light = mean(lit_.flux[*there]) / (kPi * area(*there));
  return found;
}

float NearField::gain(uint32_t vpl, const LightSet& lights, uint64_t key) const {
  if (!gaps_) return 1.0f;
  Rng rng(key, vpl);
  double light = 0.0, brought = 0.0, there = 0.0;
  for (uint32_t point = 0; point < kGainPoints; ++point) {
    coverage_.forEachLayer(vpl, r2Sequence(point, 0.5, 0.5),
                           [&](const SurfacePoint& at, float ofPoint) {
                             const Bsdf white(at, Vec3(1));
                             // By rays of its own each: where much light arrives much may be
                             // brought.
                             float arriving = 0.0f, share = 0.0f;
                             for (uint32_t k = 0; k < kGainRays; ++k) {
                               arriving += mean(directLight(rays_, lights, white, LobeGroup::Rough,
                                                            LightChoice::One, 0, rng)) +
                                           look(vpl, at.position, at.ng, rng).light;
                               share += look(vpl, at.position, at.ng, rng).brought / kGainRays;
                             }
                             light += double{ofPoint * arriving};
                             brought += double{ofPoint * arriving * share};
                           });
  }
  if (!(light > 0.0)) return 1.0f;
  constexpr uint32_t kAll = kGainPoints * kGainRays;
  for (uint32_t k = 0; k < kAll; ++k)
    there += double{look(vpl, lit_.emitPosition[vpl], lit_.emitNormal[vpl], rng).brought} / kAll;
  return static_cast<float>(std::max(brought / light, kLeastBrought) /
                            std::max(there, kLeastBrought));
}

namespace methods::compensate::near_field {

namespace {

Compensation make(const CompensateInputs& in, const Values&) {
  const auto field = std::make_shared<const NearField>(in.lit, in.rays, in.clamp, in.light);
  std::vector<float> gains(in.lit.size(), 1.0f);
  {
    const auto phase = in.progress.before("energy of VPLs", gains.size());
    const uint64_t key = streamKey(in.seed, Stream::Gains);
    parallelFor(gains.size(), 4, [&](size_t i) {
      if (mean(in.lit.flux[i]) > 0.0f)
        gains[i] = field->gain(static_cast<uint32_t>(i), in.lights, key);
      if (in.progress) in.progress(1);
    });
  }
  return {
      [field](std::span<const SurfacePoint> hits, std::span<ReachGrid::Lookup> near) {
        field->coverage().lookUp(hits, near);
      },
      [field](const SurfacePoint& seen, float distance, const ReachGrid::Lookup* near, Rng& rng) {
        return field->missing(seen, distance,
                              near ? *near : field->coverage().lookUp(seen.position), rng);
      },
      std::move(gains)};
}

}  // namespace

extern const CompensateMethod method;
const CompensateMethod method{
    "near-field", "sampled rays bring what the clamp and gaps between VPLs take", {}, make};

}  // namespace methods::compensate::near_field

}  // namespace bnvpl
