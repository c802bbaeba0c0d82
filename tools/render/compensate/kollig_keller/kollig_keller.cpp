// Bias compensation of Kollig & Keller (2006): what the bound on 1/d^2 takes from VPLs depends on
// the distance alone, and rays that go on from vertex to vertex add all of it back.
#include <array>

#include "tools/render/compensate/compensate.h"

namespace bnvpl::methods::compensate::kollig_keller {

namespace {

Compensation make(const CompensateInputs& in, const Values&) {
  const float size = in.clamp * commonRadius(in.lit);
  // Rays find the light of a vertex themselves: whichever VPLs there are, none is asked.
  return {
      [](std::span<const SurfacePoint>, std::span<ReachGrid::Lookup>) {},
      [size, kind = in.light](const SurfacePoint&, float distance, const ReachGrid::Lookup*, Rng&) {
        const UncoveredShare byDistance{INFINITY, size, kind};
        return Uncovered{byDistance.at(distance), {}, byDistance};
      }};
}

constexpr std::array kCounters{Counter{"continuedrays", "continued rays",
                                       "rays of compensation from vertices behind the first hit"}};

}  // namespace

extern const CompensateMethod method{
    .name = "kollig-keller",
    .summary = "paths of rays add all that a bound of one size for all VPLs removes; no bias",
    .options = {},
    .make = make,
    .counters = kCounters,
    .oneSize = true,
    .countsContinued = true};

}  // namespace bnvpl::methods::compensate::kollig_keller
