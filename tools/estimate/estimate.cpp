#include "tools/estimate/estimate.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.h"
#include "tools/estimate/photon_shares.h"
#include "tools/estimate/photon_sums.h"
#include "transport/coverage.h"
#include "transport/photon_walk.h"

namespace bnvpl {

namespace {

constexpr uint64_t kPhotonsPerRange = 4096;
// How far of the way a VPL moves (measured: docs/theory.md, "Radius"), and how far above the
// surface it travels, as a share of its reach.
constexpr float kRecentreShare = 0.35f;
constexpr float kRecentreLift = 0.1f;

class Scatterer {
 public:
  Scatterer(const VplTable& vpls, const RayScene& rays, const EstimateOptions& options,
            double photonPower, uint64_t photons)
      : vpls_(vpls),
        options_(options),
        fixed_(photonPower, photons),
        photonPower_(photonPower),
        perPhotonPower_(1.0 / photonPower),
        coverage_(vpls.position, vpls.normal, reachOf(vpls, options.radius), rays) {}

  void lookUp(std::span<const SurfacePoint> hits, std::span<ReachGrid::Lookup> near) const {
    coverage_.lookUp(hits, near);
  }
  // Hands the flux that leaves a diffuse hit to the VPLs around it, which `near` has found.
  void scatter(const SurfacePoint& hit, const ReachGrid::Lookup& near, Vec3 flux, bool straight,
               Rng& rng, PhotonSums& sums) const {
    ++sums.hits;
    tally(sums, kReflected, flux);
    if (options_.scatter == Scatter::Even) return scatterEvenly(hit, near, flux, straight, sums);
    scatterGuarded(hit, near, flux, straight, rng, sums);
  }
  void tally(PhotonSums& sums, Tally t, Vec3 flux) const {
    addChecked(sums.tally[t], fixed_.encode(double{mean(flux)}));
  }
  const FixedPoint& fixed() const { return fixed_; }
  double photonPower() const { return photonPower_; }
  float reach() const { return options_.radius; }

 private:
  static std::vector<float> reachOf(const VplTable& vpls, float radius) {
    std::vector<float> reach(vpls.radius);
    for (float& r : reach) r *= radius;
    return reach;
  }

  void deposit(uint32_t vpl, const SurfacePoint& hit, Vec3 flux, bool straight,
               PhotonSums& sums) const {
    VplSum& s = sums.vpl[vpl];
    for (size_t c = 0; c < 3; ++c) {
      const int64_t units = fixed_.encode(double{flux[c]});
      addChecked(s.flux[c], units);
      if (straight) addChecked(s.straight[c], units);
    }
    const double relative = double{mean(flux)} * perPhotonPower_;
    addChecked(s.squares, std::llrint(relative * relative * 0x1p20));
    const Vec3 offset =
        (hit.position - vpls_.position[vpl]) / (options_.radius * vpls_.radius[vpl]);
    for (size_t c = 0; c < 3; ++c)
      addChecked(s.moment[c], std::llrint(relative * double{offset[c]} * 0x1p24));
    ++s.photons;
  }

  // The thesis to the letter (section 3.4): evenly among all within the radius, whatever lies
  // between.
  void scatterEvenly(const SurfacePoint& hit, const ReachGrid::Lookup& near, Vec3 flux,
                     bool straight, PhotonSums& sums) const {
    uint32_t found = 0;
    ReachGrid::forEachReaching(near, [&](const ReachGrid::Disk&) { ++found; });
    if (found == 0) return tally(sums, kOutside, flux);
    const Vec3 share = flux * (1.0f / static_cast<float>(found));
    ReachGrid::forEachReaching(
        near, [&](const ReachGrid::Disk& d) { deposit(d.index, hit, share, straight, sums); });
    tally(sums, kDeposited, flux);
  }

  // Evenly among those on a compatible surface and in sight, in expectation: one of them gets all.
  void scatterGuarded(const SurfacePoint& hit, const ReachGrid::Lookup& near, Vec3 flux,
                      bool straight, Rng& rng, PhotonSums& sums) const {
    const Coverage::Found found = coverage_.pick(hit.position, hit.ng, near, rng);
    sums.guardRays += found.rays;
    if (found.vpl) {
      deposit(*found.vpl, hit, flux, straight, sums);
      return tally(sums, kDeposited, flux);
    }
    tally(sums,
          found.miss == Coverage::Miss::Outside ? kOutside
          : found.miss == Coverage::Miss::Gap   ? kGap
                                                : kHidden,
          flux);
  }

  const VplTable& vpls_;
  const EstimateOptions& options_;
  FixedPoint fixed_;
  double photonPower_, perPhotonPower_;
  Coverage coverage_;
};

// Photons on their way together: each step of one waits for memory, which the others bridge.
class PhotonBatch {
 public:
  PhotonBatch(const RayScene& rays, const Scatterer& scatterer)
      : rays_(rays),
        scatterer_(scatterer),
        photons_(kSize),
        next_(kSize),
        hits_(kSize),
        near_(kSize) {}

  // Follows photons to their ends. start(walk) makes the next one, or tells that there is none
  // left.
  template <typename Start>
  void follow(const Start& start, PhotonSums& sums) {
    size_t size = 0;
    while (size < kSize && start(photons_[size])) ++size;
    while (size > 0) {
      // Those that have ended give their places to new ones.
      for (size_t i = 0; i < size;) {
        PhotonWalk& photon = photons_[i];
        if (photon.goesOn()) {
          next_[i++] = photon.next();
          continue;
        }
        finish(photon, sums);
        if (!start(photon)) photon = photons_[--size];
      }
      meet(size);
      for (size_t i = 0; i < size; ++i) {
        photons_[i].advance(rays_, hits_[i], [&](const Bsdf& bsdf, Vec3 flux, bool straight) {
          scatterer_.scatter(bsdf.point(), near_[i], flux * bsdf.roughAlbedo(), straight,
                             photons_[i].rng(), sums);
        });
      }
    }
  }

 private:
  static constexpr size_t kSize = RayScene::kBatch;

  // What the first `size` photons hit, and the VPLs near it.
  void meet(size_t size) {
    rays_.closestHits({next_.data(), size}, hits_);
    scatterer_.lookUp({hits_.data(), size}, near_);
  }
  void finish(const PhotonWalk& photon, PhotonSums& sums) const {
    const PhotonFate& fate = photon.fate();
    scatterer_.tally(sums, kEscaped, fate.escaped);
    scatterer_.tally(sums, kAbsorbed, fate.absorbed);
    sums.rays += fate.rays;
    sums.nonFinite += fate.finite ? 0 : 1;
  }

  const RayScene& rays_;
  const Scatterer& scatterer_;
  // Of each photon: its walk, its next ray, what that hit, and the VPLs there.
  std::vector<PhotonWalk> photons_;
  std::vector<Ray> next_;
  std::vector<SurfacePoint> hits_;
  std::vector<ReachGrid::Lookup> near_;
};

PhotonSums tracePhotons(const VplTable& vpls, const RayScene& rays, const LightSet& lights,
                        const PhotonShares& shares, const Scatterer& scatterer,
                        const EstimateOptions& options, const ProgressFn& progress,
                        const Resume& resume) {
  const uint64_t key = streamKey(options.seed, Stream::Photons);
  const auto fresh = [&] {
    PhotonSums s;
    s.vpl.resize(vpls.size());
    return s;
  };
  tbb::enumerable_thread_specific<PhotonSums> perThread(fresh);
  const auto trace = [&](uint64_t begin, uint64_t end, PhotonSums& sums) {
    PhotonBatch batch(rays, scatterer);
    uint64_t photon = begin;
    batch.follow(
        [&](PhotonWalk& walk) {
          if (photon == end) return false;
          Rng rng(key, photon);
          const size_t light = shares.lightOf(photon++);
          PhotonStart start = lights.emit(light, rng);
          start.flux *= shares.weight(light);
          walk = PhotonWalk(start, options.maxBounces, rng);
          if (walk.goesOn()) scatterer.tally(sums, kEmitted, start.flux);
          return true;
        },
        sums);
  };
  std::vector<uint8_t> done((shares.total() + kPhotonsPerRange - 1) / kPhotonsPerRange);
  PhotonSums before = fresh();
  if (!resume.state.empty()) decode(resume.state, done, before);
  const auto photonsOf = [&](size_t range) {
    return std::min(kPhotonsPerRange, shares.total() - range * kPhotonsPerRange);
  };
  for (size_t range = 0; progress && range < done.size(); ++range) {
    if (done[range]) progress(photonsOf(range));
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
  return soFar();
}

void fillTable(VplTable& vpls, const PhotonSums& sums, const Scatterer& scatterer) {
  vpls.stage = VplStage::Lit;
  vpls.reach = double{scatterer.reach()};
  vpls.flux.resize(vpls.size());
  vpls.photons.resize(vpls.size());
  vpls.relativeError.resize(vpls.size());
  vpls.firstBounceFlux.resize(vpls.size());
  vpls.emitPosition = vpls.position;
  vpls.emitNormal = vpls.normal;
  for (size_t i = 0; i < vpls.size(); ++i) {
    const VplSum& s = sums.vpl[i];
    double sum = 0.0;
    for (size_t c = 0; c < 3; ++c) {
      const double value = scatterer.fixed().decode(s.flux[c]);
      vpls.flux[i][c] = static_cast<float>(value);
      sum += value / 3.0;
      vpls.firstBounceFlux[i][c] = static_cast<float>(scatterer.fixed().decode(s.straight[c]));
    }
    vpls.photons[i] = s.photons;
    // Deposits taken as independent: sqrt(sum of squares) over the sum.
    const double rootSquares =
        std::sqrt(static_cast<double>(s.squares) * 0x1p-20) * scatterer.photonPower();
    vpls.relativeError[i] = sum > 0.0 ? static_cast<float>(rootSquares / sum) : 0.0f;
  }
}

// Towards the centre of what was received, along the tangent plane and then down to the surface. A
// VPL from which the new place is not in plain sight stays.
void recentre(VplTable& vpls, const PhotonSums& sums, const Scatterer& scatterer,
              const RayScene& rays) {
  parallelFor(vpls.size(), 256, [&](size_t i) {
    const double weight = double{mean(vpls.flux[i])} / scatterer.photonPower();
    if (!(weight > 0.0)) return;
    const Vec3 position = vpls.position[i], n = vpls.normal[i];
    const float reach = scatterer.reach() * vpls.radius[i], lift = kRecentreLift * reach;
    Vec3 offset;
    for (size_t c = 0; c < 3; ++c) {
      offset[c] = static_cast<float>(double(sums.vpl[i].moment[c]) * 0x1p-24 / weight) * reach;
    }
    offset = (offset + n * -dot(n, offset)) * kRecentreShare;
    const Vec3 above = position + offset + n * lift;
    SurfacePoint hit;
    if (rays.occluded(position + n * lift, above) || !rays.closestHit(above, -n, hit)) return;
    if (hit.distance > 2.0f * lift || dot(hit.ng, n) < kMinNormalDot) return;
    vpls.emitPosition[i] = hit.position;
    vpls.emitNormal[i] = hit.ng;
  });
}

}  // namespace

EnergyAccount estimateFlux(VplTable& vpls, const RayScene& rays, const LightSet& lights,
                           const EstimateOptions& options, const ProgressFn& progress,
                           const Resume& resume) {
  lights.requirePower();
  const double power = double{mean(lights.totalPower())};
  const PhotonShares shares(lights, options.photons);
  const Scatterer scatterer(vpls, rays, options, power / static_cast<double>(shares.total()),
                            shares.total());
  const PhotonSums sums =
      tracePhotons(vpls, rays, lights, shares, scatterer, options, progress, resume);
  fillTable(vpls, sums, scatterer);
  if (options.recentre) recentre(vpls, sums, scatterer, rays);

  const auto watts = [&](Tally t) { return scatterer.fixed().decode(sums.tally[t]); };
  EnergyAccount a;
  a.emitted = watts(kEmitted);
  a.escaped = watts(kEscaped);
  a.absorbed = watts(kAbsorbed);
  a.reflected = watts(kReflected);
  a.deposited = watts(kDeposited);
  a.outside = watts(kOutside);
  a.gap = watts(kGap);
  a.hidden = watts(kHidden);
  a.photons = shares.total();
  a.hits = sums.hits;
  a.rays = sums.rays;
  a.guardRays = sums.guardRays;
  a.nonFinite = sums.nonFinite;
  return a;
}

}  // namespace bnvpl
