#include "tools/estimate/photon_deposits.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "core/parallel.h"
#include "core/random_streams.h"
#include "tools/estimate/photon_batch.h"

namespace bnvpl {

namespace {

constexpr std::string_view kPhotonWork = "photons", kPhotonPointsWork = "emit-points";
constexpr uint64_t rangesOf(uint64_t photons) {
  return (photons + kPhotonsPerRange - 1) / kPhotonsPerRange;
}

void fillTable(VplTable& vpls, const PhotonSums& sums, const PhotonDeposits& deposits) {
  beginLit(vpls, deposits.radius());
  for (size_t i = 0; i < vpls.size(); ++i) {
    const VplSum& s = sums.vpl[i];
    double sum = 0.0;
    for (size_t c = 0; c < 3; ++c) {
      const double value = deposits.fixed().decode(s.flux[c]);
      vpls.flux[i][c] = static_cast<float>(value);
      sum += value / 3.0;
      vpls.firstBounceFlux[i][c] = static_cast<float>(deposits.fixed().decode(s.firstBounce[c]));
    }
    vpls.photons[i] = s.photons;
    vpls.relativeError[i] =
        sum > 0.0 ? static_cast<float>(std::sqrt(deposits.variance(s)) / sum) : 0.0f;
  }
}

// Merges the emission points of all shards. Each shard has recorded its own under the index of its
// first part.
EmitPoints emitPointsOfShards(const ShardSource& source, EmitPoints all) {
  std::vector<EmitPoint> some(all.winners().size());
  for (uint64_t part = 0; part < source.parts; ++part) {
    if (!source.record(kPhotonPointsWork, part)) continue;
    takeRecord(source, kPhotonPointsWork, part, some);
    all.add(some);
  }
  return all;
}

}  // namespace

EnergyAccount accountOf(const PhotonSums& sums, const PhotonDeposits& deposits, uint64_t photons) {
  const auto watts = [&](Tally t) { return deposits.fixed().decode(sums.tally[t]); };
  EnergyAccount a;
  a.emitted = watts(kEmitted);
  a.escaped = watts(kEscaped);
  a.absorbed = watts(kAbsorbed);
  a.reflected = watts(kReflected);
  a.deposited = watts(kDeposited);
  a.outside = watts(kOutside);
  a.incompatible = watts(kIncompatible);
  a.hidden = watts(kHidden);
  a.photons = photons;
  a.hits = sums.hits;
  a.rays = sums.rays;
  a.guardRays = sums.guardRays;
  a.nonFinite = sums.nonFinite;
  return a;
}

namespace {

PhotonSums sumsOfShards(const EstimateInputs& in, const PhotonRun& run) {
  const ShardSource& source = *in.controls.source;
  const size_t vpls = in.vpls.size(), groups = run.deposits.groups();
  PhotonSums sums = sumsOf(source.sums(kPhotonWork, integersFor(vpls, groups)), vpls, groups);
  sums.points = emitPointsOfShards(source, EmitPoints(in.vpls, run.emitPoints, mix64(run.key)));
  return sums;
}

// The start of a photon, with its share of the flux of its light. `density` is relative to emission
// by power.
PhotonStart startOf(const LightSet& lights, const PhotonRun& run, uint64_t photon, Rng& rng,
                    size_t& light, float& density) {
  density = 1.0f;
  if (!run.guide || !run.guide->guides()) {
    light = run.perLight.lightOf(photon);
    PhotonStart start = lights.emit(light, rng);
    start.flux *= run.perLight.weight(light);
    return start;
  }
  const auto total = static_cast<double>(run.perLight.total());
  const EmissionSample e =
      run.guide->draw((static_cast<double>(photon) + double{rng.next()}) / total, rng, density);
  light = e.light;
  PhotonStart start = lights.emit(light, e.at);
  start.flux *=
      static_cast<float>(1.0 / (total * double{lights.pickProbability(light)} * double{density}));
  return start;
}

}  // namespace

PhotonSums tracePhotons(const EstimateInputs& in, const PhotonRun& run, const DepositRule& rule) {
  const PhotonsPerLight& perLight = run.perLight;
  const ProgressFn& progress = in.progress;
  const WorkControls& controls = in.controls;
  if (controls.source) return sumsOfShards(in, run);
  const auto fresh = [&] {
    PhotonSums s;
    s.vpl.resize(in.vpls.size());
    s.groups.resize(in.vpls.size() * run.deposits.groups());
    s.points = EmitPoints(in.vpls, run.emitPoints, mix64(run.key));
    return s;
  };
  tbb::enumerable_thread_specific<PhotonSums> perThread(fresh);
  const auto trace = [&](uint64_t begin, uint64_t end, PhotonSums& sums) {
    PhotonBatch batch(in.accel, run.deposits, rule);
    uint64_t photon = begin;
    batch.follow(
        [&](PhotonWalk& walk, bool& hittable, uint32_t& group, float& density) {
          if (photon == end) return false;
          Rng rng(run.key, photon);
          size_t light = 0;
          const PhotonStart start = startOf(in.lights, run, photon++, rng, light, density);
          hittable = in.lights.hittable(light);
          group = in.lights.group(light);
          walk = PhotonWalk(start, run.maxBounces, rng);
          if (walk.goesOn()) run.deposits.tally(sums, kEmitted, start.flux);
          return true;
        },
        sums);
  };
  std::vector<uint8_t> done = unitsToDo(rangesOf(perLight.total()), controls.shard);
  PhotonSums before = fresh();
  if (!controls.state.empty()) decode(controls.state, done, before);
  const auto photonsOf = [&](size_t range) {
    return std::min(kPhotonsPerRange, perLight.total() - range * kPhotonsPerRange);
  };
  uint64_t doneBefore = 0;  // reported at once, as it says nothing of the speed
  for (size_t range = 0; range < done.size(); ++range)
    if (done[range] == 1 && controls.shard.has(range)) doneBefore += photonsOf(range);
  if (progress && doneBefore > 0) progress(doneBefore);
  const auto withThreads = [&](PhotonSums total) {
    for (const PhotonSums& s : perThread) total.add(s);
    return total;
  };
  forUnitsLeft(
      done, controls,
      [&](size_t range) {
        const uint64_t begin = range * kPhotonsPerRange, count = photonsOf(range);
        trace(begin, begin + count, perThread.local());
        if (progress) progress(count);
      },
      [&] { return encode(done, withThreads(before)); });
  PhotonSums sums = withThreads(std::move(before));
  if (controls.sink) {
    controls.sink->sums(kPhotonWork, integersOf(sums));
    giveRecord(*controls.sink, kPhotonPointsWork, controls.shard.first, sums.points.winners());
  }
  return sums;
}

std::string finishedState(const PhotonSums& sums, uint64_t photons) {
  return encode(std::vector<uint8_t>(rangesOf(photons), 1), sums);
}

void depositToOneInSight(const PhotonDeposits& deposits, const PhotonHit& hit, Rng& rng,
                         PhotonSums& sums) {
  const Coverage::Found found =
      deposits.coverage().pick(hit.point.position, hit.point.ng, hit.near, rng);
  sums.guardRays += found.rays;
  if (found.vpl) {
    deposits.deposit(*found.vpl, hit, hit.flux, sums);
    return deposits.tally(sums, kDeposited, hit.flux);
  }
  deposits.tally(sums,
                 found.miss == Coverage::Miss::Outside        ? kOutside
                 : found.miss == Coverage::Miss::Incompatible ? kIncompatible
                                                              : kHidden,
                 hit.flux);
}

PhotonDeposits::PhotonDeposits(const EstimateInputs& in, const Coverage& coverage, float radius,
                               uint64_t photons)
    : position_(in.vpls.position),
      vplRadius_(in.vpls.radius),
      radius_(radius),
      groups_(in.accel.scene().lightGroupCount()),
      photonPower_(double{mean(in.lights.totalPower())} / static_cast<double>(photons)),
      fixed_(photonPower_, photons),
      invPhotonPower_(1.0 / photonPower_),
      squareUnit_(std::ldexp(1.0, -std::min(36, 54 - static_cast<int>(std::bit_width(photons))))),
      coverage_(coverage) {}

namespace {

// Squares are rounded as FixedPoint::encode() does. One hit counts for at most 2^55 units, so that
// a photon that grazes a smooth-shaded edge, of 1e4 times the mean flux, does not end the run.
int64_t squareUnits(double value, float u) {
  return static_cast<int64_t>(std::floor(std::min(value, 0x1p55) + double{u}));
}

}  // namespace

void PhotonDeposits::deposit(uint32_t vpl, const PhotonHit& hit, Vec3 flux,
                             PhotonSums& sums) const {
  if (!misRatios_.empty() && !hit.onlyPhotons)
    flux *= hit.density / (hit.density + misRatios_[vpl]);
  // Relative to the VPL, so that the unit of length does not matter.
  const Vec3 place = (hit.point.position - position_[vpl]) / vplRadius_[vpl];
  const float u = toUnitFloat(mix64(positionHash(place)));
  VplSum& s = sums.vpl[vpl];
  GroupSum* group = groups_ > 0 ? &sums.groups[size_t{vpl} * groups_ + hit.group] : nullptr;
  for (size_t c = 0; c < 3; ++c) {
    const int64_t units = fixed_.encode(double{flux[c]}, u);
    addChecked(s.flux[c], units);
    if (hit.firstBounce) addChecked(s.firstBounce[c], units);
    if (hit.onlyPhotons) addChecked(s.onlyPhotons[c], units);
    if (group) addChecked(group->flux[c], units);
    if (group && hit.firstBounce) addChecked(group->firstBounce[c], units);
  }
  const double relative = double{mean(flux)} * invPhotonPower_;
  const double square = relative * relative / squareUnit_;
  addChecked(s.squares, squareUnits(square, u));
  if (hit.onlyPhotons)
    addChecked(s.onlySquares, squareUnits(square, u));
  else
    addChecked(s.squaresByPower, squareUnits(square * double{hit.density}, u));
  sums.points.offer(vpl, double{mean(flux)}, hit.point);  // in watts, as paths offer theirs
  ++s.photons;
}

VplGroups PhotonDeposits::groupFlux(const PhotonSums& sums) const {
  VplGroups out(sums.vpl.size(), groups_);
  for (size_t i = 0; i < sums.groups.size(); ++i) {
    for (size_t c = 0; c < 3; ++c) {
      out.flux[i][c] = static_cast<float>(fixed_.decode(sums.groups[i].flux[c]));
      out.firstBounceFlux[i][c] = static_cast<float>(fixed_.decode(sums.groups[i].firstBounce[c]));
    }
  }
  return out;
}

EstimateResult estimateByPhotons(const EstimateInputs& in, const Values& options,
                                 const DepositRule& rule) {
  in.lights.requirePower();
  const PhotonsPerLight perLight(in.lights, options[kPhotonsOption]);
  const Coverage coverage = coverageOf(in.vpls, in.accel, options.real32(kRadiusOption));
  const PhotonDeposits deposits(in, coverage, options.real32(kRadiusOption), perLight.total());
  const auto maxBounces = static_cast<unsigned>(options[kPhotonBouncesOption]);
  const LearnedEmission emission =
      learnPhotonEmission(in, coverage, options, maxBounces, perLight.total());
  const PhotonRun run{streamKey(options[kSeedOption], RandomStream::Photons),
                      options[kEmitPointsOption],
                      maxBounces,
                      perLight,
                      deposits,
                      &emission.guide};
  const PhotonSums sums = tracePhotons(in, run, rule);
  EstimateResult result{in.vpls, accountOf(sums, deposits, perLight.total())};
  result.useful = emission.useful;
  fillTable(result.table, sums, deposits);
  finishGroups(deposits.groupFlux(sums), result.table);
  sums.points.fill(result.table);
  return result;
}

}  // namespace bnvpl
