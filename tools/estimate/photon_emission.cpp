#include "tools/estimate/photon_emission.h"

#include <algorithm>
#include <cmath>

#include "core/random_streams.h"
#include "tools/estimate/photon_deposits.h"
#include "transport/photons/photon_walk.h"

namespace bnvpl {

namespace {

constexpr uint64_t kPhotonsPerPilotPhoton = 32, kMaxPilot = 1 << 20;
constexpr uint64_t kPilotPhotonsPerFluxPhoton = 4;  // those that estimate the VPLs' flux
constexpr uint64_t kTrialPhotons = 1 << 16;         // limit for a cost trial (--estimate)

// Weights of the VPLs' variances: one over the flux plus kMinFlux times the mean flux. Photons that
// start by power measure it.
std::vector<double> weightsByFlux(const EstimateInputs& in, const PhotonDeposits& deposits,
                                  const PhotonRun& run) {
  const auto phase = in.progress.beginPhase("flux pilot, photons", run.perLight.total());
  const PhotonSums sums =
      tracePhotons({in.vpls, in.accel, in.lights, in.progress, {}}, run, depositToOneInSight);
  std::vector<double> weights(in.vpls.size());
  double mean = 0.0;
  for (size_t i = 0; i < weights.size(); ++i) {
    for (const int64_t flux : sums.vpl[i].flux) weights[i] += deposits.fixed().decode(flux);
    mean += weights[i] / static_cast<double>(weights.size());
  }
  for (double& w : weights) w = mean > 0.0 ? 1.0 / (w + kMinFlux * mean) : 1.0;
  return weights;
}

}  // namespace

LearnedEmission learnPhotonEmission(const EstimateInputs& in, const Coverage& coverage,
                                    const Values& options, unsigned maxBounces, uint64_t photons) {
  if (options.meet(valueIs(kEmissionOption, "power")) || in.controls.source)
    return {EmissionGuide(in.lights)};
  const uint64_t pilot = std::min(kMaxPilot,
                                  (photons + kPhotonsPerPilotPhoton - 1) / kPhotonsPerPilotPhoton),
                 sent = unitsToTry(in.controls.trial, pilot, kTrialPhotons);
  const CostTrial::Part part(in.controls.trial,
                             static_cast<double>(pilot) / static_cast<double>(sent));
  const uint64_t key = streamKey(options[kSeedOption], RandomStream::PhotonEmission);
  const PhotonsPerLight perLight(in.lights,
                                 std::max<uint64_t>(1, sent / kPilotPhotonsPerFluxPhoton));
  const PhotonDeposits deposits(in, coverage, options.real32(kRadiusOption), perLight.total());
  const std::vector<double> weights =
      weightsByFlux(in, deposits, {mix64(key), 0, maxBounces, perLight, deposits});
  return learnEmission(
      in.lights, sent - sent / kPilotPhotonsPerFluxPhoton, key,
      [&](const EmissionSample&, const PhotonStart& start, Rng& rng, bool) {
        double squares = 0.0;
        Rng choice = rng.fork();  // which of several VPLs gets the light
        followPhoton(
            in.accel, PhotonWalk(start, maxBounces, rng), [&](const Bsdf& bsdf, Vec3 flux, bool) {
              const SurfacePoint& hit = bsdf.point();
              const auto found =
                  coverage.pick(hit.position, hit.ng, coverage.lookUp(hit.position), choice);
              if (!found.vpl) return;
              const double deposit{mean(flux * bsdf.roughAlbedo())};
              squares += deposit * deposit * weights[*found.vpl];
            });
        return PilotContribution{std::sqrt(squares)};
      },
      in.progress);
}

}  // namespace bnvpl
