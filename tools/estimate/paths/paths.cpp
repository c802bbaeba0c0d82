// Estimates the flux of each VPL by paths from points of its surface back to the lights. This is
// the integral that photons estimate, from the other end of the path. Its cost does not grow with
// the parts of the scene that do not light the view, but light sampling must find the lights from
// the VPLs.
#include <array>
#include <cmath>

#include "core/random_streams.h"
#include "tools/estimate/vpl_paths.h"

namespace bnvpl::methods::estimate::paths {

namespace {

constexpr auto kPointsOption =
    countOption("points", "64", 1u << 20, "", "points on the surface that each VPL stands for");
constexpr auto kOptions =
    optionTable(kPointsOption, kPathsOption, kRadiusOption, kPathBouncesOption, kEmitPointsOption);

EstimateResult run(const EstimateInputs& in, const Values& options) {
  in.lights.requirePower();
  const auto spatialLights = makeSpatialLightSampler(in, options[kSeedOption]);
  // A cost trial (--estimate) takes fewer points and paths.
  CostTrial* const trial = in.controls.trial;
  const uint64_t each = options[kPointsOption], fewPoints = unitsToTry(trial, each, 8),
                 paths = options[kPathsOption], fewPaths = unitsToTry(trial, paths, 8);
  const Coverage coverage = coverageOf(in.vpls, in.accel, options.real32(kRadiusOption));
  const VplPaths vplPaths(in, coverage,
                          {streamKey(options[kSeedOption], RandomStream::VplPaths), fewPaths,
                           static_cast<unsigned>(options[kPathBouncesOption]),
                           options[kEmitPointsOption], spatialLights.get()});
  const std::vector<uint64_t> points(in.vpls.size(), fewPoints);
  WorkControls controls = in.controls;
  controls.trialScale = static_cast<double>(each) * static_cast<double>(paths) /
                        static_cast<double>(fewPoints * fewPaths);
  const PathResult received =
      tracePathsOfAll({in.vpls, in.accel, in.lights, in.progress, controls}, vplPaths, points);
  EstimateResult result{in.vpls, {}, 0};
  VplTable& lit = result.table;
  beginLit(lit, options.real32(kRadiusOption));
  for (size_t i = 0; i < lit.size(); ++i) {
    const PathSums& r = received.sums[i];
    const double flux = r.meanFlux();
    for (size_t c = 0; c < 3; ++c) {
      lit.flux[i][c] = static_cast<float>(r.flux[c]);
      lit.firstBounceFlux[i][c] = static_cast<float>(r.firstBounce[c]);
    }
    if (flux > 0.0) lit.relativeError[i] = static_cast<float>(std::sqrt(r.variance()) / flux);
    result.paths += r.paths;
    result.energy.nonFinite += r.nonFinite;
  }
  VplGroups groups(lit.size(), vplPaths.groups());
  addGroupsTo(groups, received);
  finishGroups(std::move(groups), lit);
  received.points.fill(lit);
  return result;
}

Work work(const VplTable& vpls, const Values& options) {
  return {"paths", vpls.size() * options[kPointsOption] * options[kPathsOption]};
}

}  // namespace

extern const EstimateMethod method{"paths", "paths from the surface of each VPL back to the lights",
                                   kOptions, run, work};

}  // namespace bnvpl::methods::estimate::paths
