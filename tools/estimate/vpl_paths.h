// Shared by the methods of vpl-estimate that trace paths from the surface of a VPL back to the
// lights.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "tools/estimate/emit_points.h"
#include "tools/estimate/estimate.h"
#include "tools/estimate/lit_columns.h"
#include "transport/coverage.h"
#include "transport/outgoing_radiance.h"

namespace bnvpl {

inline constexpr auto kPathBouncesOption = inTopic(
    Topic::Quality,
    wholeOption("max-bounces", "32", 1, 1000, "",
                "bounces off rough surfaces between a light and the view, with that at the VPL"));
inline constexpr WholeOption kPathsOption =
    countOption("paths", "4", 1u << 20, "", "paths from each point");

// Estimate of a VPL's flux from points of its surface, W.
struct PathSums {  // without padding, as its bytes are saved
  std::array<double, 3> flux{}, firstBounce{};
  double squares = 0.0;  // sum over points of their squared contribution to meanFlux()
  uint64_t points = 0, paths = 0, rays = 0, nonFinite = 0;

  double meanFlux() const { return (flux[0] + flux[1] + flux[2]) / 3.0; }
  // Variance of meanFlux(), W^2, if points were independent; flux^2 for a single one, 0 for none.
  double variance() const;
};

// The flux of one light group, W.
struct GroupPathSum {
  std::array<double, 3> flux{}, firstBounce{};
};

// VPLs that shards and progress count together.
inline constexpr size_t kVplsPerUnit = 16;

class VplPaths {
 public:
  struct Settings {
    uint64_t key, paths;                                 // paths from each point
    unsigned maxBounces;                                 // at least 1, the bounce at the VPL
    size_t emitPoints;                                   // per VPL
    const SpatialLightSampler* spatialLights = nullptr;  // learned distribution for light sampling
    // One ratio for each VPL, for MIS with the photons from `guide` (PhotonMis); empty: no photons
    // share its flux.
    std::span<const float> misRatio = {};
    const EmissionGuide* guide = nullptr;
  };
  // Borrows `in` and `coverage`.
  VplPaths(const EstimateInputs& in, const Coverage& coverage, const Settings& settings)
      : in_(in),
        settings_(settings),
        coverage_(coverage),
        length_{settings.maxBounces - 1},
        groups_(in.accel.scene().lightGroupCount()) {}

  // Estimates the flux of one VPL from points of its disk, and offers them as emission points.
  // `byGroup` receives the flux of each light group.
  PathSums tracePaths(uint32_t vpl, uint64_t points, EmitPoints& emitPoints,
                      std::span<GroupPathSum> byGroup) const;
  uint32_t groups() const { return groups_; }  // light groups; 0: not told apart
  EmitPoints emptyEmitPoints() const {
    return {in_.vpls, settings_.emitPoints, mix64(settings_.key)};
  }
  uint64_t pathsOf(uint64_t points) const { return points * settings_.paths; }

 private:
  double add(const SurfacePoint& hit, float area, const PhotonMis& photons, Rng& rng, PathSums& r,
             std::span<GroupPathSum> byGroup) const;

  const EstimateInputs& in_;
  Settings settings_;
  const Coverage& coverage_;
  PathLength length_;
  uint32_t groups_;
};

// Learns the distribution of light sampling for paths from the VPLs' surfaces. Null for a merge,
// which traces no paths.
std::unique_ptr<const SpatialLightSampler> makeSpatialLightSampler(const EstimateInputs& in,
                                                                   uint64_t seed);

struct PathResult {
  std::vector<PathSums> sums;  // one per VPL
  EmitPoints points;
  std::vector<GroupPathSum> groups;  // those of each VPL, row after row
};

// Estimates the flux of every VPL i from points[i] points. `in.controls` and `in.progress` are for
// this work alone; progress counts paths.
PathResult tracePathsOfAll(const EstimateInputs& in, const VplPaths& vplPaths,
                           std::span<const uint64_t> points);
// Adds the flux by light group.
void addGroupsTo(VplGroups& groups, const PathResult& paths);
// WorkControls state of tracePathsOfAll() when all of its work is done.
std::string finishedState(const PathResult& result);

}  // namespace bnvpl
