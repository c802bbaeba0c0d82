// Estimates the flux of each VPL from both ends: by photons from the lights and by paths from the
// VPL. Small pilots measure the variance of both, and from it follow the sample allocation and the
// weights of the two estimates. The fluxes of the pilots are not used otherwise, so weights and
// estimates are independent.
#include <array>
#include <atomic>
#include <cmath>

#include "core/random_streams.h"
#include "tools/estimate/both/phases.h"
#include "tools/estimate/both/split.h"
#include "tools/estimate/both/split_records.h"
#include "tools/estimate/photon_deposits.h"
#include "tools/estimate/vpl_paths.h"

namespace bnvpl::methods::estimate::both {

namespace {

constexpr auto kTotalWorkOption = inTopic(
    Topic::Main, countOption("photons", "10M", 0x1p36, "",
                             "total work, as a number of photons; paths take a part of it"));
constexpr auto kIrradianceErrorOption =
    inTopic(Topic::Speed, realOption("irradiance-error", "0.005", 0, 1, "",
                                     "do less work if pilots predict that VPLs cause at most this "
                                     "mean relative error in all light in view; 0: do all work"));
constexpr auto kOptions =
    optionTable(kTotalWorkOption, kEmissionOption, kIrradianceErrorOption, kPathsOption,
                kRadiusOption, kPathBouncesOption, kEmitPointsOption);

// Each pilot gets about this share of the work.
constexpr double kPilot = 1.0 / 32.0;
// Assumed number of rays per path, for the size of the pilot; the pilot measures the true one.
constexpr double kGuessedRays = 10.0;
constexpr uint64_t kMinPoints = 2, kMaxPoints = 32;
// Paths are not used at all if their pilot would take more than this share of the work.
constexpr double kMaxPilotShare = 0.25;
// Less indirect light than this share of the light in view is treated as this share.
constexpr double kMinIndirectShare = 0.05;
// Limits of a cost trial: photons and paths of pilots, VPLs of the split, points per VPL after it.
constexpr uint64_t kTrialPhotons = 1 << 18, kTrialVpls = 8192;
constexpr double kTrialPaths = 1 << 18, kTrialPoints = 8.0;
constexpr uint64_t kMinUnits = 256;
// Phases of the work. Shards divide the last two, and each makes the pilots by itself.
constexpr size_t kPhotonPilotPhase = 0, kPathPilotPhase = 1, kPhotonPhase = 2, kPathPhase = 3;

// Photons of a phase, and the sums of their deposits.
struct PhotonWork {
  PhotonsPerLight perLight;
  PhotonDeposits deposits;
  PhotonSums sums;

  PhotonWork(const EstimateInputs& in, const Coverage& coverage, float radius, uint64_t count)
      : perLight(in.lights, count), deposits(in, coverage, radius, perLight.total()) {}

  double mean3(const std::array<int64_t, 3>& v) const {
    const FixedPoint& f = deposits.fixed();
    return (f.decode(v[0]) + f.decode(v[1]) + f.decode(v[2])) / 3.0;
  }
};

class Estimator {
 public:
  Estimator(const EstimateInputs& in, const Values& options)
      : in_(in),
        options_(options),
        phases_(in.controls),
        coverage_(coverageOf(in.vpls, in.accel, options.real32(kRadiusOption))),
        emission_{EmissionGuide(in.lights)},
        work_(options[kTotalWorkOption]) {}

  EstimateResult run() {
    in_.lights.requirePower();
    emission_ = learnPhotonEmission(in_, coverage_, options_, maxBounces(), work_);
    const Split split = in_.controls.trial    ? splitOfTrial()
                        : in_.controls.source ? takeSplit(*in_.controls.source, in_.vpls.size())
                                              : pilot();
    if (in_.controls.sink && in_.controls.shard.has(0)) giveSplit(*in_.controls.sink, split);
    // A cost trial traces about as many units of photons as of paths, so that any part of it has
    // both.
    const uint64_t sent = unitsToTry(
        in_.controls.trial, split.photons,
        kPhotonsPerRange * std::max<uint64_t>(kMinUnits, in_.vpls.size() / kVplsPerUnit));
    PhotonWork photons = trace(kPhotonPhase, RandomStream::Photons, sent, split.misRatio,
                               static_cast<double>(split.photons) / static_cast<double>(sent));
    const PathResult paths = traceSplitPaths(split);
    return combine(split, std::move(photons), paths);
  }

 private:
  // Runs work(progress), which does `units` units that count as `photons` photons in the overall
  // progress; pilots, which every shard repeats, by its share.
  template <typename Work>
  auto withProgress(size_t phase, uint64_t photons, uint64_t units, const Work& work) {
    photons = std::min(photons, work_ - reported_);
    reported_ += photons;
    if (phase < kPhotonPhase) photons = in_.controls.shard.shareOf(photons);
    std::atomic<uint64_t> done{0};
    const auto photonsOf = [&](uint64_t n) {
      return static_cast<uint64_t>(static_cast<double>(photons) * static_cast<double>(n) /
                                   static_cast<double>(units));
    };
    ProgressFn progress;
    if (in_.progress && units > 0) {
      progress = [&](uint64_t n) {
        const uint64_t before = done.fetch_add(n);
        in_.progress(photonsOf(before + n) - photonsOf(before));
      };
    }
    auto result = work(progress);
    if (in_.progress && units == 0) in_.progress(photons);
    return result;
  }

  size_t emitPointsOf(size_t phase) const {  // pilots need none
    return phase < kPhotonPhase ? 0 : options_[kEmitPointsOption];
  }

  PhotonWork trace(size_t phase, RandomStream stream, uint64_t count,
                   std::span<const float> misRatios = {}, double trialScale = 1.0) {
    PhotonWork work(in_, coverage_, options_.real32(kRadiusOption), count);
    work.deposits.setMisRatios(misRatios);
    const PhotonRun run{streamKey(options_[kSeedOption], stream),
                        emitPointsOf(phase),
                        maxBounces(),
                        work.perLight,
                        work.deposits,
                        &emission_.guide};
    const auto equivalent = static_cast<uint64_t>(progressScale_ * static_cast<double>(count));
    work.sums = phases_.run(
        phase, trialScale,
        [&](const WorkControls& controls) {
          return withProgress(
              phase, equivalent, work.perLight.total(), [&](const ProgressFn& progress) {
                return tracePhotons({in_.vpls, in_.accel, in_.lights, progress, controls}, run,
                                    depositToOneInSight);
              });
        },
        [&](const PhotonSums& sums) { return finishedState(sums, work.perLight.total()); });
    return work;
  }

  PathResult tracePaths(size_t phase, RandomStream stream, std::span<const uint64_t> points,
                        std::span<const float> misRatios, uint64_t equivalent,
                        double trialScale = 1.0) {
    if (!spatialLights_ && std::ranges::count(points, 0u) < std::ssize(points))
      spatialLights_ = makeSpatialLightSampler(in_, options_[kSeedOption]);
    const VplPaths vplPaths(
        in_, coverage_,
        {streamKey(options_[kSeedOption], stream), options_[kPathsOption], maxBounces(),
         emitPointsOf(phase), spatialLights_.get(), misRatios, &emission_.guide});
    return phases_.run(
        phase, trialScale,
        [&](const WorkControls& controls) {
          uint64_t all = 0;
          for (const uint64_t n : points) all += vplPaths.pathsOf(n);
          return withProgress(phase, equivalent, all, [&](const ProgressFn& progress) {
            return tracePathsOfAll({in_.vpls, in_.accel, in_.lights, progress, controls}, vplPaths,
                                   points);
          });
        },
        [](const PathResult& result) { return finishedState(result); });
  }

  // A cost trial takes fewer points, in proportion; the rounding remainder goes to the next VPL.
  PathResult traceSplitPaths(const Split& split) {
    std::vector<uint64_t> points = split.points;
    double all = 0.0, few = 0.0, left = 0.0;
    for (const uint64_t n : points) all += static_cast<double>(n);
    const double most = kTrialPoints * static_cast<double>(points.size());
    const double share = in_.controls.trial && all > most ? most / all : 1.0;
    for (uint64_t& n : points) {
      left += share * static_cast<double>(n);
      n = share < 1.0 ? static_cast<uint64_t>(left) : n;
      left -= static_cast<double>(n);
      few += static_cast<double>(n);
    }
    return tracePaths(kPathPhase, RandomStream::VplPaths, points, split.misRatio, work_ - reported_,
                      few > 0.0 ? all / few : 1.0);
  }

  // The error of --irradiance-error is relative to all light in view, of which VPLs give a share.
  double irradianceError() const {
    return options_[kIrradianceErrorOption] / std::max(in_.vpls.indirectShare, kMinIndirectShare);
  }
  unsigned maxBounces() const { return static_cast<unsigned>(options_[kPathBouncesOption]); }

  // The parts of a cost trial share one split.
  const Split& splitOfTrial() {
    std::any& kept = in_.controls.trial->kept;
    if (!kept.has_value()) kept = pilot();
    return std::any_cast<const Split&>(kept);
  }

  void photonPilot(uint64_t few, Pilots& pilots) {
    const uint64_t sent = unitsToTry(in_.controls.trial, few, kTrialPhotons);
    const PhotonWork photons = trace(kPhotonPilotPhase, RandomStream::PilotPhotons, sent, {},
                                     static_cast<double>(few) / static_cast<double>(sent));
    if (sent < few) reported_ = few;
    pilots.photons = static_cast<double>(photons.perLight.total());
    pilots.photonPower = photons.deposits.photonPower();
    pilots.photonCost =
        static_cast<double>(photons.sums.rays + photons.sums.guardRays) / pilots.photons;
    for (const VplSum& s : photons.sums.vpl) {
      const double only = photons.mean3(s.onlyPhotons), all = photons.mean3(s.flux);
      const double onlyVariance = photons.deposits.onlyVariance(s);
      pilots.byPhotons.push_back({all - only, photons.deposits.variance(s) - onlyVariance,
                                  photons.deposits.varianceByPower(s), only, onlyVariance});
    }
  }

  // Returns the rays traced. A cost trial measures every `step`-th VPL, which represents those that
  // follow it in the file.
  double pathPilot(uint64_t points, uint64_t photonsBefore, Pilots& pilots) {
    const size_t count = in_.vpls.size();
    const double paths = static_cast<double>(count * points * options_[kPathsOption]);
    const auto step =
        static_cast<size_t>(in_.controls.trial ? std::ceil(paths / kTrialPaths) : 1.0);
    std::vector<uint64_t> pointsOf(count, 0);
    for (size_t i = 0; i < count; i += step) pointsOf[i] = points;
    const PathResult pilot = tracePaths(kPathPilotPhase, RandomStream::PilotPaths, pointsOf, {},
                                        photonsBefore, static_cast<double>(step));
    pilots.points = static_cast<double>(points);
    double rays = 0.0;
    for (size_t i = 0; i < count; ++i) {
      const PathSums& s = pilot.sums[i - i % step];
      pilots.byPaths.push_back({s.meanFlux(), s.variance()});
      pilots.pointCost.push_back(static_cast<double>(s.rays) / pilots.points);
      rays += static_cast<double>(s.rays);
    }
    return rays;
  }

  Split pilot() {
    const auto few = static_cast<uint64_t>(std::ceil(kPilot * static_cast<double>(work_)));
    Pilots pilots;
    photonPilot(few, pilots);
    const double whole = pilots.photonCost * static_cast<double>(work_);
    const double guess = static_cast<double>(in_.vpls.size()) * kGuessedRays *
                         static_cast<double>(options_[kPathsOption]);
    if (guess * kMinPoints > kMaxPilotShare * whole)
      return photonsAlone(work_ - reported_, in_.vpls.size());
    const uint64_t points =
        std::clamp<uint64_t>(static_cast<uint64_t>(kPilot * whole / guess), kMinPoints, kMaxPoints);
    const bool trial = in_.controls.trial != nullptr;
    const double spent = pilots.photonCost * (trial ? static_cast<double>(few) : pilots.photons) +
                         pathPilot(points, few, pilots);
    const auto dark = [](const auto& pilot) { return pilot.flux == 0.0; };
    // Nothing tells how to divide the work, as where only photons find the light.
    if (!trial && std::ranges::all_of(pilots.byPhotons, dark) &&
        std::ranges::all_of(pilots.byPaths, dark))
      return photonsAlone(work_ - reported_, in_.vpls.size());
    const WorkBudget budget{std::max(whole - spent, 0.5 * whole), irradianceError()};
    const Split split =
        trial ? splitOfSubset(pilots, budget) : splitWork(in_.vpls, in_.accel, pilots, budget);
    progressScale_ = static_cast<double>(work_ - reported_) * pilots.photonCost / split.cost;
    return split;
  }

  // Split for a cost trial, from every `step`-th VPL, which represents those that follow it. A
  // photon serves all VPLs, so its cost is divided by `step`; the irradiance from fewer VPLs has a
  // larger error.
  Split splitOfSubset(Pilots pilots, WorkBudget budget) const {
    const size_t count = in_.vpls.size(), step = (count + kTrialVpls - 1) / kTrialVpls;
    const auto trialScale = static_cast<double>(step);
    std::vector<uint32_t> rows;
    for (size_t i = 0; i < count; i += step) rows.push_back(static_cast<uint32_t>(i));
    const auto keep = [&](auto& all) {
      for (size_t k = 0; k < rows.size(); ++k) all[k] = all[rows[k]];
      all.resize(rows.size());
    };
    keep(pilots.byPhotons);
    keep(pilots.byPaths);
    keep(pilots.pointCost);
    pilots.photonCost /= trialScale;
    const CostTrial::Part part(in_.controls.trial, trialScale);
    const Split some = splitWork(keepRows(in_.vpls, rows), in_.accel, pilots,
                                 {budget.cost / trialScale, budget.error * std::sqrt(trialScale)});
    Split split = some;
    split.cost *= trialScale;
    split.points.resize(count);
    split.misRatio.resize(count);
    for (size_t i = 0; i < count; ++i) {
      split.points[i] = some.points[i / step];
      split.misRatio[i] = some.misRatio[i / step];
    }
    return split;
  }

  // Flux of each VPL: the sum of the contributions of photons and paths, which have MIS weights.
  EstimateResult combine(const Split& split, PhotonWork&& photons, const PathResult& paths) const {
    EstimateResult result{in_.vpls,
                          accountOf(photons.sums, photons.deposits, photons.perLight.total()), 0};
    VplTable& lit = result.table;
    beginLit(lit, options_.real32(kRadiusOption));
    const FixedPoint& fixed = photons.deposits.fixed();
    for (size_t i = 0; i < lit.size(); ++i) {
      const VplSum& s = photons.sums.vpl[i];
      const PathSums& r = paths.sums[i];
      double sum = 0.0;
      for (size_t c = 0; c < 3; ++c) {
        const double flux = fixed.decode(s.flux[c]) + r.flux[c];
        lit.flux[i][c] = static_cast<float>(flux);
        lit.firstBounceFlux[i][c] = std::min(
            lit.flux[i][c], static_cast<float>(fixed.decode(s.firstBounce[c]) + r.firstBounce[c]));
        sum += flux / 3.0;
      }
      lit.photons[i] = s.photons;
      const double variance = photons.deposits.variance(s) + r.variance();
      if (sum > 0.0) lit.relativeError[i] = static_cast<float>(std::sqrt(variance) / sum);
      result.paths += r.paths;
      result.energy.nonFinite += r.nonFinite;
    }
    result.workShare = split.costShare;
    result.photonsAlone = split.withoutPaths;
    result.useful = emission_.useful;
    VplGroups groups = photons.deposits.groupFlux(photons.sums);
    addGroupsTo(groups, paths);
    finishGroups(std::move(groups), lit);
    EmitPoints points = std::move(photons.sums.points);
    points.add(paths.points.winners());
    points.fill(lit);
    return result;
  }

  const EstimateInputs& in_;
  const Values& options_;
  Phases<4, kPhotonPhase> phases_;
  Coverage coverage_;
  LearnedEmission emission_;
  std::unique_ptr<const SpatialLightSampler> spatialLights_;
  uint64_t work_, reported_ = 0;  // in photons: all work, and that of the phases begun
  double progressScale_ = 1.0;    // photons of progress per photon traced, if less work is enough
};

EstimateResult run(const EstimateInputs& in, const Values& options) {
  return Estimator(in, options).run();
}

Work work(const VplTable&, const Values& options) { return {"photons", options[kTotalWorkOption]}; }

}  // namespace

extern const EstimateMethod method{
    "both", "photons and paths; the better at it counts more in each light path", kOptions, run,
    work};

}  // namespace bnvpl::methods::estimate::both
