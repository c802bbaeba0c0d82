// What the methods of vpl-estimate share that gather a VPL's light where it stands: paths from
// points of its surface back to the lights.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "tools/estimate/emit_points.h"
#include "tools/estimate/estimate.h"
#include "tools/estimate/vpl_surface.h"
#include "transport/coverage.h"
#include "transport/leaving_light.h"

namespace bnvpl {

inline constexpr Option kPathsOption =
    countOption("paths", "4", 1u << 20, "", "paths from each of these points");

// What a VPL sends, W, as its points have it.
struct PathSums {  // without padding: it is saved as it lies
  std::array<double, 3> flux{}, firstBounce{};
  double squares = 0.0;  // of the mean flux of a point
  uint64_t points = 0, paths = 0, rays = 0, nonFinite = 0;

  double meanFlux() const { return (flux[0] + flux[1] + flux[2]) / 3.0; }
  double variance() const;  // of the mean flux, points taken as independent; 0 for a single one
};

class VplPaths {
 public:
  struct Settings {
    uint64_t key, paths;                   // from each point
    unsigned maxBounces;                   // at least 1: that at the VPL
    float radius;                          // how far a VPL reaches, r_max
    size_t emitPoints;                     // of each VPL
    const SurfaceLights* where = nullptr;  // where light sampling looks for lights
  };
  VplPaths(const EstimateInputs& in, const Settings& settings)
      : in_(in),
        settings_(settings),
        coverage_(in.vpls.position, in.vpls.normal, reachOf(in.vpls, settings.radius), in.rays),
        length_{settings.maxBounces - 1} {}

  // Of one VPL, by so many points of its disk, which run for `ends`, too.
  PathSums gather(uint32_t vpl, uint64_t points, EmitPoints& ends) const;
  EmitPoints noEmitPoints() const { return {in_.vpls, settings_.emitPoints, mix64(settings_.key)}; }
  uint64_t pathsOf(uint64_t points) const { return points * settings_.paths; }

 private:
  double add(const SurfacePoint& hit, float area, Rng& rng, PathSums& r) const;

  const EstimateInputs& in_;
  Settings settings_;
  Coverage coverage_;
  PathLength length_;
};

// Where paths from the surfaces that VPLs stand for look for lights; null for a merge, which traces
// none.
std::unique_ptr<const SurfaceLights> lightsOfPaths(const EstimateInputs& in, uint64_t seed);

struct PathResult {
  std::vector<PathSums> sums;  // of each VPL
  EmitPoints points;
};

// Of all VPLs, by `points` of each. `in.resume` and `in.progress`, in paths, are those of this work
// alone.
PathResult gatherAll(const EstimateInputs& in, const VplPaths& gatherer,
                     std::span<const uint64_t> points);
// The state with which that work, resumed, is at its end.
std::string finishedState(const PathResult& result);

}  // namespace bnvpl
