#include "tools/render/compensate/near_field/near_field.h"

#include <memory>

#include "core/random.h"
#include "core/sampling.h"

namespace bnvpl {

namespace {

// Reach, in radii of the VPL, of those from vpl-place --method light, which have no reach of their
// own.
constexpr float kReachWithoutPhotons = 2.0f;
// A VPL's area is measured with kAreaPoints points of its disk, or up to kMaxAreaPoints until
// kMinFound of them lie on its surface. If fewer do, the surface is a sliver of unknown area.
constexpr uint32_t kAreaPoints = 32, kMaxAreaPoints = 256, kMinFound = 8;
// A ray shorter than this many radii of a VPL ends in a crevice or a corner, where the light
// differs from the mean over the VPL's surface: further rays find the point's own light instead
// (measured).
constexpr float kShortRay = 0.7f;
constexpr float kUnknown = -1.0f;  // an area that is not measured yet

std::vector<float> scaled(std::vector<float> values, float factor) {
  for (float& v : values) v *= factor;
  return values;
}

// Area of the surface that VPL i covers, world units squared; 0 if unknown.
float areaOf(uint32_t i, const Coverage& coverage) {
  float sum = 0.0f;
  uint32_t points = 0, found = 0;
  for (; points < kAreaPoints || (found < kMinFound && points < kMaxAreaPoints); ++points) {
    const float before = sum;
    coverage.forEachSurface(i, r2Sequence(points, 0.5, 0.5),
                            [&](const SurfacePoint&, float area) { sum += area; });
    found += sum > before;
  }
  return found < kMinFound ? 0.0f : sum / static_cast<float>(points);
}

}  // namespace

NearField::NearField(const VplTable& lit, const Accelerator& accel, float clamp, VplKind kind,
                     const VplGroups& groups)
    : lit_(lit),
      coverage_(lit.position, lit.normal,
                scaled(lit.radius, lit.reachFactor > 0.0 ? static_cast<float>(lit.reachFactor)
                                                         : kReachWithoutPhotons),
                accel),
      kind_(kind),
      clampRadius_(scaled(lit.radius, clamp)),
      groups_(groups.groups),
      multiBounceFlux_(groups.flux),
      area_(lit.size()),
      covers_(lit.reachFactor > 0.0) {
  for (std::atomic<float>& area : area_) area = kUnknown;
  for (size_t i = 0; i < multiBounceFlux_.size(); ++i)
    multiBounceFlux_[i] = groups.flux[i] - groups.firstBounceFlux[i];
}

std::optional<float> NearField::perFluxOf(uint32_t vpl) const {
  if (!covers_) return {};  // the flux of a single photon belongs to no area
  // Two threads may measure the same area; both find the same value.
  float area = area_[vpl].load(std::memory_order_relaxed);
  if (area == kUnknown) {
    area = areaOf(vpl, coverage_);
    area_[vpl].store(area, std::memory_order_relaxed);
  }
  if (!(area > 0.0f)) return {};
  return 1.0f / (kPi * area);
}

Uncovered NearField::uncovered(const SurfacePoint& point, float distance,
                               const ReachGrid::Lookup& coverLookup, Rng& rng) const {
  const Coverage::Found found = coverage_.pick(point.position, point.ng, coverLookup, rng);
  if (!found.vpl) {
    return {covers_ ? 1.0f : 0.0f, {}, {covers_ ? INFINITY : 0.0f, INFINITY, kind_}};
  }
  const float relative = distance / clampRadius_[*found.vpl];
  const float share = withKind(kind_, [&](auto k) { return k.removed(relative); });
  const float shortest = kShortRay * lit_.radius[*found.vpl];
  if (distance < shortest) return {share, {}, {shortest, clampRadius_[*found.vpl], kind_}};
  Uncovered out{share, {}, {}};
  const std::optional<float> perFlux = perFluxOf(*found.vpl);
  if (!perFlux) return out;
  out.multiBounceRadiance = (lit_.flux[*found.vpl] - lit_.firstBounceFlux[*found.vpl]) * *perFlux;
  out.perFlux = *perFlux;
  if (groups_ > 0) out.multiBounceFlux = &multiBounceFlux_[size_t{*found.vpl} * groups_];
  return out;
}

namespace methods::compensate::near_field {

namespace {

Compensation make(const CompensateInputs& in, const Values&) {
  const auto field =
      std::make_shared<const NearField>(in.lit, in.accel, in.clamp, in.light, in.groups);
  return {[field](std::span<const SurfacePoint> hits, std::span<ReachGrid::Lookup> coverLookup) {
            field->coverage().lookUp(hits, coverLookup);
          },
          [field](const SurfacePoint& point, float distance, const ReachGrid::Lookup* coverLookup,
                  Rng& rng) {
            return field->uncovered(
                point, distance,
                coverLookup ? *coverLookup : field->coverage().lookUp(point.position), rng);
          }};
}

}  // namespace

extern const CompensateMethod method{
    .name = "near-field",
    .summary =
        "sampled rays add the light that the clamp removes and that comes from areas "
        "without a VPL",
    .options = {},
    .make = make,
    .bytesPerVpl = 840.0};

}  // namespace methods::compensate::near_field

}  // namespace bnvpl
