#include "tools/render/compensate/near_field/near_field.h"

#include <memory>

#include "core/random.h"
#include "core/sampling.h"

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

std::optional<Vec3> NearField::scatteredBy(uint32_t vpl) const {
  if (!gaps_) return {};  // the flux of a photon says nothing of the area around it
  // Two threads may measure one area; both find the same.
  float area = area_[vpl].load(std::memory_order_relaxed);
  if (area == kUnknown) {
    area = areaOf(vpl, coverage_);
    area_[vpl].store(area, std::memory_order_relaxed);
  }
  if (!(area > 0.0f)) return {};
  return (lit_.flux[vpl] - lit_.firstBounceFlux[vpl]) * (1.0f / (kPi * area));
}

Missing NearField::missing(const SurfacePoint& seen, float distance, const ReachGrid::Lookup& near,
                           Rng& rng) const {
  const Coverage::Found found = coverage_.pick(seen.position, seen.ng, near, rng);
  if (!found.vpl) {
    return {gaps_ ? 1.0f : 0.0f, {}, {gaps_ ? INFINITY : 0.0f, INFINITY, kind_}};
  }
  const float relative = distance / clampRadius_[*found.vpl];
  const float share = withKind(kind_, [&](auto k) { return k.removed(relative); });
  const float shortest = kShortRay * lit_.radius[*found.vpl];
  if (distance < shortest) return {share, {}, {shortest, clampRadius_[*found.vpl], kind_}};
  return {share, scatteredBy(*found.vpl), {}};
}

namespace methods::compensate::near_field {

namespace {

Compensation make(const CompensateInputs& in, const Values&) {
  const auto field = std::make_shared<const NearField>(in.lit, in.rays, in.clamp, in.light);
  return {
      [field](std::span<const SurfacePoint> hits, std::span<ReachGrid::Lookup> near) {
        field->coverage().lookUp(hits, near);
      },
      [field](const SurfacePoint& seen, float distance, const ReachGrid::Lookup* near, Rng& rng) {
        return field->missing(seen, distance,
                              near ? *near : field->coverage().lookUp(seen.position), rng);
      }};
}

}  // namespace

extern const CompensateMethod method;
const CompensateMethod method{
    "near-field", "sampled rays bring what the clamp and gaps between VPLs take", {}, make};

}  // namespace methods::compensate::near_field

}  // namespace bnvpl
