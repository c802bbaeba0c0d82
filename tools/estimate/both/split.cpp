#include "tools/estimate/both/split.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/parallel.h"
#include "spatial/compatible_surface.h"
#include "spatial/kd_tree.h"
#include "tools/estimate/both/receivers.h"

namespace bnvpl::methods::estimate::both {

namespace {

// VPLs that are judged together: the nearest that look the same way. Of the wide pool only the
// ratio of the two variances counts, for rare bright samples take many to show.
constexpr size_t kPool = 16, kWidePool = 96, kNearest = 160;
// How many of their standard errors pilots may differ without one of them having missed something.
constexpr double kSurprise = 2.0;
// Photons always get at least one of so many parts: no path finds what only they bring.
constexpr int kParts = 16;
// The flux that errors of a VPL are judged by is at least this share of the mean VPL's: when work
// is shared out, and when it is enough.
constexpr double kMinFlux = 0.1, kMinFluxOfError = 0.01;
// Work that might be enough: all, and so many times less in steps of a fourth of an octave.
constexpr int kSteps = 24;
constexpr double kStep = 0.8408964152537145;  // 2^(-1/4)

// Of the VPLs around one, for one way to find their flux.
struct Pool {
  double flux = 0.0, variance = 0.0;
};

// One sample that the pilot might just have missed: of the energy of those that it had, here or,
// where there were none, anywhere.
double missedSquared(const Pool& here, double sampleAnywhere) {
  const double sample = here.flux > 0.0 ? here.variance / here.flux : sampleAnywhere;
  return sample * sample;
}

double sampleOf(const std::vector<Found>& found) {
  double flux = 0.0, variance = 0.0;
  for (const Found& f : found) flux += f.flux, variance += f.variance;
  return flux > 0.0 ? variance / flux : 0.0;
}

// Of one VPL: the variance of a single photon and of a single point, the flux expected there, and
// the cost of a point.
struct Judged {
  double photon = 0.0, point = 0.0, flux = 0.0, cost = 0.0;
};

// Of a pool: variances of the mean VPL's flux by each of the pilots, and that flux.
struct Compared {
  double byPhotons = 0.0, byPoints = 0.0, flux = 0.0;
  double ratio() const { return byPhotons > 0.0 ? byPoints / byPhotons : 0.0; }
};

Compared compare(std::span<const uint32_t> pool, const Pilots& pilots, double photonSample,
                 double pointSample) {
  Pool photons, points;
  for (const uint32_t k : pool) {
    photons.flux += pilots.byPhotons[k].flux;
    photons.variance += pilots.byPhotons[k].variance;
    points.flux += pilots.byPaths[k].flux;
    points.variance += pilots.byPaths[k].variance;
  }
  photons.variance += missedSquared(photons, photonSample);
  points.variance += missedSquared(points, pointSample);
  // Light that one of them found and the other did not comes to the other in samples as rare and
  // bright as that: about one in all that the pilot drew here.
  const double difference = photons.flux - points.flux;
  const double noise = kSurprise * std::sqrt(photons.variance + points.variance);
  const double missedByPoints = std::max(0.0, difference - noise);
  const double missedByPhotons = std::max(0.0, -difference - noise);
  points.variance += missedByPoints * missedByPoints;
  photons.variance += missedByPhotons * missedByPhotons;
  const double sum = photons.variance + points.variance;
  const auto size = static_cast<double>(pool.size());
  return {photons.variance / size, points.variance / size,
          sum > 0.0
              ? (photons.flux * points.variance + points.flux * photons.variance) / (sum * size)
              : 0.0};
}

Judged judge(std::span<const uint32_t> wide, const Pilots& pilots, double photonSample,
             double pointSample) {
  const auto near = wide.first(std::min(kPool, wide.size()));
  const Compared here = compare(near, pilots, photonSample, pointSample);
  const Compared around = compare(wide, pilots, photonSample, pointSample);
  Judged j;
  j.flux = here.flux;
  j.photon = here.byPhotons * pilots.photons;
  j.point = here.byPhotons * std::max(here.ratio(), around.ratio()) * pilots.points;
  for (const uint32_t k : near) j.cost += pilots.pointCost[k] / static_cast<double>(near.size());
  return j;
}

std::vector<Judged> judgeAll(const VplTable& vpls, const Pilots& pilots) {
  const KdTree tree(vpls.position);
  const double photonSample = std::max(sampleOf(pilots.byPhotons), 1e-6 * pilots.photonPower);
  const double pointSample = sampleOf(pilots.byPaths);
  std::vector<Judged> judged(vpls.size());
  parallelRanges(vpls.size(), 256, [&](size_t begin, size_t end) {
    std::vector<Neighbour> near;
    std::vector<uint32_t> pool;
    for (size_t i = begin; i < end; ++i) {
      tree.nearest(vpls.position[i], kNearest, near);
      pool.clear();
      for (const Neighbour& n : near) {
        if (pool.size() < kWidePool && dot(vpls.normal[n.index], vpls.normal[i]) >= kMinNormalDot)
          pool.push_back(n.index);
      }
      judged[i] = judge(pool, pilots, photonSample, pointSample);
    }
  });
  return judged;
}

// Points for each VPL beside so many photons, for a price of error per cost.
class Points {
 public:
  explicit Points(std::vector<Judged> judged)
      : judged_(std::move(judged)), weight_(judged_.size()) {
    double mean = 0.0;
    for (const Judged& j : judged_) mean += j.flux / static_cast<double>(judged_.size());
    for (size_t i = 0; i < weight_.size(); ++i)
      weight_[i] = 1.0 / std::max(judged_[i].flux + kMinFlux * mean, 1e-300);
  }

  // Least weight / (photons / v_photon + n / v_point) + price cost n: Neyman's allocation, beside
  // what photons know already.
  double at(size_t i, double photons, double price) const {
    const Judged& j = judged_[i];
    if (!(j.point > 0.0)) return 0.0;
    return std::max(
        0.0, std::sqrt(weight_[i] * j.point / (price * j.cost)) - photons * j.point / j.photon);
  }
  double costAt(double photons, double price) const {
    double sum = 0.0;
    for (size_t i = 0; i < judged_.size(); ++i) sum += judged_[i].cost * at(i, photons, price);
    return sum;
  }
  // The price at which points cost so much.
  double priceFor(double photons, double cost) const {
    double low = -700.0, high = 700.0;  // its logarithm
    for (int step = 0; step < 60; ++step) {
      const double middle = (low + high) / 2.0;
      (costAt(photons, std::exp(middle)) > cost ? low : high) = middle;
    }
    return std::exp(high);
  }
  double errorAt(double photons, double price) const {
    double sum = 0.0;
    for (size_t i = 0; i < judged_.size(); ++i) sum += weight_[i] * variance(i, photons, price);
    return sum;
  }
  double relativeErrorAt(double photons, double price, const Receivers& receivers) const {
    std::vector<double> flux, variances;
    for (size_t i = 0; i < judged_.size(); ++i) {
      flux.push_back(judged_[i].flux);
      variances.push_back(variance(i, photons, price));
    }
    return receivers.relativeError(flux, variances);
  }
  double share(size_t i, double photons, double points) const {
    const Judged& j = judged_[i];
    if (!(points > 0.0)) return 1.0;
    return photons * j.point / (photons * j.point + points * j.photon);
  }

 private:
  double variance(size_t i, double photons, double price) const {
    const Judged& j = judged_[i];
    const double known = photons / j.photon;
    return 1.0 / (j.point > 0.0 ? known + at(i, photons, price) / j.point : known);
  }

  std::vector<Judged> judged_;
  std::vector<double> weight_;
};

// The number of photons, and the price of points beside them.
struct Shares {
  double photons = 0.0, price = INFINITY, error = INFINITY;
};

Shares bestShares(const Points& points, double photonCost, double cost) {
  Shares best;
  for (int part = 1; part <= kParts; ++part) {
    const double ofPhotons = cost * part / kParts, photons = ofPhotons / photonCost;
    const double price = part == kParts ? INFINITY : points.priceFor(photons, cost - ofPhotons);
    const double error = points.errorAt(photons, price);
    if (error < best.error) best = {photons, price, error};
  }
  return best;
}

// From all of the work down, as long as the rest is enough.
Shares sharesWithin(const Points& points, const VplTable& vpls, const RayScene& rays,
                    double photonCost, const Budget& budget) {
  Shares best = bestShares(points, photonCost, budget.cost);
  if (!(budget.error > 0.0)) return best;
  const Receivers receivers(vpls, rays);
  double cost = budget.cost;
  for (int step = 0; step < kSteps; ++step) {
    cost *= kStep;
    const Shares less = bestShares(points, photonCost, cost);
    if (!(points.relativeErrorAt(less.photons, less.price, receivers) <= budget.error)) break;
    best = less;
  }
  return best;
}

}  // namespace

Split splitWork(const VplTable& vpls, const RayScene& rays, const Pilots& pilots,
                const Budget& budget) {
  const Points points(judgeAll(vpls, pilots));
  const Shares best = sharesWithin(points, vpls, rays, pilots.photonCost, budget);
  Split split;
  split.photons = std::max<uint64_t>(1, static_cast<uint64_t>(std::llround(best.photons)));
  split.points.resize(vpls.size());
  split.share.resize(vpls.size());
  const auto photons = static_cast<double>(split.photons);
  split.cost = photons * pilots.photonCost + points.costAt(photons, best.price);
  split.costShare = std::min(1.0, split.cost / budget.cost);
  for (size_t i = 0; i < vpls.size(); ++i) {
    split.points[i] = static_cast<uint64_t>(std::llround(points.at(i, photons, best.price)));
    split.share[i] = points.share(i, photons, static_cast<double>(split.points[i]));
  }
  return split;
}

}  // namespace bnvpl::methods::estimate::both
