#include "tools/estimate/photon_scatter.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "core/parallel.h"
#include "tools/common/files/streams.h"
#include "transport/photon_walk.h"

namespace bnvpl {

namespace {

constexpr uint64_t kPhotonsPerRange = 4096;
constexpr std::string_view kPhotonWork = "photons", kPhotonPointsWork = "emit-points";
constexpr uint64_t rangesOf(uint64_t photons) {
  return (photons + kPhotonsPerRange - 1) / kPhotonsPerRange;
}

// Photons that advance together, one ray each per round, which hides the latency of memory.
class PhotonBatch {
 public:
  PhotonBatch(const Accelerator& accel, const PhotonScatter& scatter, const ScatterRule& rule)
      : accel_(accel),
        scatter_(scatter),
        rule_(rule),
        photons_(kSize),
        hittable_(kSize),
        group_(kSize),
        next_(kSize),
        hits_(kSize),
        near_(kSize) {}

  // Follows photons to their ends. start(walk, hittable, group) makes the next photon and sets
  // whether rays can hit its light, and its light group; it returns false if none is left.
  template <typename Start>
  void follow(const Start& start, PhotonSums& sums) {
    size_t size = 0;
    while (size < kSize && startAt(size, start)) ++size;
    while (size > 0) {
      // New photons replace those that have ended.
      for (size_t i = 0; i < size;) {
        PhotonWalk& photon = photons_[i];
        if (photon.goesOn()) {
          next_[i++] = photon.next();
          continue;
        }
        finish(photon, sums);
        if (startAt(i, start)) continue;
        photon = photons_[--size];
        hittable_[i] = hittable_[size];
        group_[i] = group_[size];
      }
      intersect(size);
      for (size_t i = 0; i < size; ++i) {
        photons_[i].advance(accel_, hits_[i], [&](const Bsdf& bsdf, Vec3 flux, bool firstBounce) {
          const Vec3 leaving = flux * bsdf.roughAlbedo();
          ++sums.hits;
          scatter_.tally(sums, kReflected, leaving);
          const bool onlyPhotons = !hittable_[i] && photons_[i].beganAtPerfectMirror();
          rule_(scatter_, {bsdf.point(), near_[i], leaving, firstBounce, onlyPhotons, group_[i]},
                photons_[i].rng(), sums);
        });
      }
    }
  }

 private:
  static constexpr size_t kSize = Accelerator::kBatch;

  template <typename Start>
  bool startAt(size_t i, const Start& start) {
    bool hittable = false;
    if (!start(photons_[i], hittable, group_[i])) return false;
    hittable_[i] = hittable;
    return true;
  }
  // Finds the hits of the first `size` photons, and the VPLs near them.
  void intersect(size_t size) {
    accel_.closestHits({next_.data(), size}, hits_);
    scatter_.coverage().lookUp(std::span(std::as_const(hits_)).first(size), near_);
  }
  void finish(const PhotonWalk& photon, PhotonSums& sums) const {
    const PhotonFate& fate = photon.fate();
    scatter_.tally(sums, kEscaped, fate.escaped);
    scatter_.tally(sums, kAbsorbed, fate.absorbed);
    sums.rays += fate.rays;
    sums.nonFinite += fate.finite ? 0 : 1;
  }

  const Accelerator& accel_;
  const PhotonScatter& scatter_;
  const ScatterRule& rule_;
  // One entry per photon: its walk, whether rays can hit its light, its light group, its next ray,
  // the hit, and VPLs near it.
  std::vector<PhotonWalk> photons_;
  std::vector<uint8_t> hittable_;
  std::vector<uint32_t> group_;
  std::vector<Ray> next_;
  std::vector<SurfacePoint> hits_;
  std::vector<ReachGrid::Lookup> near_;
};

void fillTable(VplTable& vpls, const PhotonSums& sums, const PhotonScatter& scatter) {
  beginLit(vpls, scatter.radius());
  for (size_t i = 0; i < vpls.size(); ++i) {
    const VplSum& s = sums.vpl[i];
    double sum = 0.0;
    for (size_t c = 0; c < 3; ++c) {
      const double value = scatter.fixed().decode(s.flux[c]);
      vpls.flux[i][c] = static_cast<float>(value);
      sum += value / 3.0;
      vpls.firstBounceFlux[i][c] = static_cast<float>(scatter.fixed().decode(s.firstBounce[c]));
    }
    vpls.photons[i] = s.photons;
    vpls.relativeError[i] =
        sum > 0.0 ? static_cast<float>(std::sqrt(scatter.variance(s)) / sum) : 0.0f;
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

EnergyAccount accountOf(const PhotonSums& sums, const PhotonScatter& scatter, uint64_t photons) {
  const auto watts = [&](Tally t) { return scatter.fixed().decode(sums.tally[t]); };
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
  const ShardSource& source = *in.resume.source;
  const size_t vpls = in.vpls.size(), groups = run.scatter.groups();
  PhotonSums sums = sumsOf(source.sums(kPhotonWork, integersFor(vpls, groups)), vpls, groups);
  sums.points = emitPointsOfShards(source, EmitPoints(in.vpls, run.emitPoints, mix64(run.key)));
  return sums;
}

// The start of a photon, with its share of the flux of its light.
PhotonStart startOf(const LightSet& lights, const PhotonRun& run, uint64_t photon, Rng& rng,
                    size_t& light) {
  if (!run.guide || !run.guide->guides()) {
    light = run.shares.lightOf(photon);
    PhotonStart start = lights.emit(light, rng);
    start.flux *= run.shares.weight(light);
    return start;
  }
  const auto total = static_cast<double>(run.shares.total());
  const Emission e =
      run.guide->draw((static_cast<double>(photon) + double{rng.next()}) / total, rng);
  light = e.light;
  PhotonStart start = lights.emit(light, e.at);
  start.flux *= static_cast<float>(
      1.0 / (total * double{lights.pickProbability(light)} * double{run.guide->density(e)}));
  return start;
}

}  // namespace

PhotonSums tracePhotons(const EstimateInputs& in, const PhotonRun& run, const ScatterRule& rule) {
  const PhotonShares& shares = run.shares;
  const ProgressFn& progress = in.progress;
  const Resume& resume = in.resume;
  if (resume.source) return sumsOfShards(in, run);
  const auto fresh = [&] {
    PhotonSums s;
    s.vpl.resize(in.vpls.size());
    s.groups.resize(in.vpls.size() * run.scatter.groups());
    s.points = EmitPoints(in.vpls, run.emitPoints, mix64(run.key));
    return s;
  };
  tbb::enumerable_thread_specific<PhotonSums> perThread(fresh);
  const auto trace = [&](uint64_t begin, uint64_t end, PhotonSums& sums) {
    PhotonBatch batch(in.accel, run.scatter, rule);
    uint64_t photon = begin;
    batch.follow(
        [&](PhotonWalk& walk, bool& hittable, uint32_t& group) {
          if (photon == end) return false;
          Rng rng(run.key, photon);
          size_t light = 0;
          const PhotonStart start = startOf(in.lights, run, photon++, rng, light);
          hittable = in.lights.hittable(light);
          group = in.lights.group(light);
          walk = PhotonWalk(start, run.maxBounces, rng);
          if (walk.goesOn()) run.scatter.tally(sums, kEmitted, start.flux);
          return true;
        },
        sums);
  };
  std::vector<uint8_t> done = unitsToDo(rangesOf(shares.total()), resume.shard);
  PhotonSums before = fresh();
  if (!resume.state.empty()) decode(resume.state, done, before);
  const auto photonsOf = [&](size_t range) {
    return std::min(kPhotonsPerRange, shares.total() - range * kPhotonsPerRange);
  };
  for (size_t range = 0; progress && range < done.size(); ++range) {
    if (done[range] == 1) progress(photonsOf(range));
  }
  const auto soFar = [&] {
    PhotonSums total = before;
    for (const PhotonSums& s : perThread) total.add(s);
    return total;
  };
  forUnitsLeft(
      done, resume,
      [&](size_t range) {
        const uint64_t begin = range * kPhotonsPerRange, count = photonsOf(range);
        trace(begin, begin + count, perThread.local());
        if (progress) progress(count);
      },
      [&] { return encode(done, soFar()); });
  PhotonSums sums = soFar();
  if (resume.sink) {
    resume.sink->sums(kPhotonWork, integersOf(sums));
    giveRecord(*resume.sink, kPhotonPointsWork, resume.shard.first, sums.points.winners());
  }
  return sums;
}

std::string finishedState(const PhotonSums& sums, uint64_t photons) {
  return encode(std::vector<uint8_t>(rangesOf(photons), 1), sums);
}

void scatterToOneInSight(const PhotonScatter& scatter, const PhotonHit& hit, Rng& rng,
                         PhotonSums& sums) {
  const Coverage::Found found =
      scatter.coverage().pick(hit.point.position, hit.point.ng, hit.near, rng);
  sums.guardRays += found.rays;
  if (found.vpl) {
    scatter.deposit(*found.vpl, hit, hit.flux, sums);
    return scatter.tally(sums, kDeposited, hit.flux);
  }
  scatter.tally(sums,
                found.miss == Coverage::Miss::Outside        ? kOutside
                : found.miss == Coverage::Miss::Incompatible ? kIncompatible
                                                             : kHidden,
                hit.flux);
}

PhotonScatter::PhotonScatter(const EstimateInputs& in, float radius, uint64_t photons)
    : radius_(radius),
      groups_(in.accel.scene().lightGroupCount()),
      photonPower_(double{mean(in.lights.totalPower())} / static_cast<double>(photons)),
      fixed_(photonPower_, photons),
      perPhotonPower_(1.0 / photonPower_),
      squareUnit_(std::ldexp(1.0, -std::min(36, 54 - static_cast<int>(std::bit_width(photons))))),
      coverage_(in.vpls.position, in.vpls.normal, reachOf(in.vpls, radius), in.accel) {}

namespace {

// Up or down, so that the mean over hits is the value: squares of photons that a guide makes faint
// are less than a unit.
int64_t roundedAtRandom(double value, Vec3 at) {
  const double low = std::floor(value);
  const bool up = double{toUnitFloat(mix64(placeHash(at)))} < value - low;
  return static_cast<int64_t>(low) + (up ? 1 : 0);
}

}  // namespace

void PhotonScatter::deposit(uint32_t vpl, const PhotonHit& hit, Vec3 flux, PhotonSums& sums) const {
  VplSum& s = sums.vpl[vpl];
  for (size_t c = 0; c < 3; ++c) {
    const int64_t units = fixed_.encode(double{flux[c]});
    addChecked(s.flux[c], units);
    if (hit.firstBounce) addChecked(s.firstBounce[c], units);
    if (hit.onlyPhotons) addChecked(s.onlyPhotons[c], units);
  }
  const double relative = double{mean(flux)} * perPhotonPower_;
  addChecked(s.squares, roundedAtRandom(relative * relative / squareUnit_, hit.point.position));
  const double weight = emitPointWeights_.empty() || hit.onlyPhotons ? 1.0 : emitPointWeights_[vpl];
  // In watts, as paths offer theirs.
  sums.points.offer(vpl, double{mean(flux)} * weight, hit.point);
  if (groups_ > 0) {
    GroupSum& group = sums.groups[size_t{vpl} * groups_ + hit.group];
    for (size_t c = 0; c < 3; ++c) {
      const int64_t units = fixed_.encode(double{flux[c]} * weight);
      addChecked(group.flux[c], units);
      if (hit.firstBounce) addChecked(group.firstBounce[c], units);
    }
  }
  ++s.photons;
}

VplGroups PhotonScatter::groupFlux(const PhotonSums& sums) const {
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
                                 const ScatterRule& rule) {
  in.lights.requirePower();
  const PhotonShares shares(in.lights, options[kPhotonsOption]);
  const PhotonScatter scatter(in, options.real32(kRadiusOption), shares.total());
  const auto maxBounces = static_cast<unsigned>(options[kPhotonBouncesOption]);
  const LearnedEmission emission = learnPhotonEmission(in, options, maxBounces, shares.total());
  const PhotonRun run{streamKey(options[kSeedOption], Stream::Photons),
                      options[kEmitPointsOption],
                      maxBounces,
                      shares,
                      scatter,
                      &emission.guide};
  const PhotonSums sums = tracePhotons(in, run, rule);
  EstimateResult result{in.vpls, accountOf(sums, scatter, shares.total())};
  result.useful = emission.useful;
  fillTable(result.table, sums, scatter);
  finishGroups(scatter.groupFlux(sums), result.table);
  sums.points.fill(result.table);
  return result;
}

}  // namespace bnvpl
