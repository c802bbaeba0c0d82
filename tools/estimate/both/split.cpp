#include "tools/estimate/both/split.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <ranges>

#include "core/parallel.h"
#include "spatial/compatible_surface.h"
#include "spatial/kd_tree.h"
#include "tools/estimate/both/irradiance_probes.h"
#include "tools/estimate/lit_columns.h"

namespace bnvpl::methods::estimate::both {

namespace {

// Pilots are pooled over the nearest VPLs whose normals differ by at most 60 degrees. Rare bright
// samples show only in the wide pool.
constexpr size_t kPool = 16, kWidePool = 96, kNearest = 160;
// Number of samples in a pool that are trusted as much as the pool around it.
constexpr double kTrusted = 10.0;
// Standard deviations by which the pilots may differ before one of them is taken to have missed
// light.
constexpr double kMaxDeviations = 2.0;
// Photons always get at least one of this many parts of the work, since some light is found only by
// photons.
constexpr int kParts = 16;
// Budgets that smallestAllocation() tries, in steps of a quarter of an octave.
constexpr int kSteps = 24;
constexpr double kStep = 0.8408964152537145;  // 2^(-1/4)

// Sums over the VPLs of a pool, for one of the two pilots.
struct Pooled {
  double flux = 0.0, variance = 0.0;
};

// Sum of g x^2 over that of x^2, over the pool's deposits x of photons that started with the
// density g: by how much photons vary less than if they started by power. Where the pool has no
// photons, it is that of the pool around it.
double startDensity(std::span<const uint32_t> pool, const std::vector<PilotEstimate>& photons,
                    double around) {
  double variance = 0.0, byPower = 0.0;
  for (const uint32_t k : pool)
    variance += photons[k].variance, byPower += photons[k].varianceByPower;
  return variance > 0.0 && byPower > 0.0 ? byPower / variance : around;
}

// Square of a typical sample, variance / flux, that the pilot may have missed. It is taken from
// this pool or, if that has no flux, from all VPLs.
double missedSquared(const Pooled& here, double sampleAnywhere) {
  const double sample = here.flux > 0.0 ? here.variance / here.flux : sampleAnywhere;
  return sample * sample;
}

double meanSample(const std::vector<PilotEstimate>& found) {
  double flux = 0.0, variance = 0.0;
  for (const PilotEstimate& f : found) flux += f.flux, variance += f.variance;
  return flux > 0.0 ? variance / flux : 0.0;
}

// Statistics of a VPL, pooled over those around it.
struct VplStatistics {
  double photonVariance = 0.0;  // variance of one photon's deposit, W^2
  double pointVariance = 0.0;   // variance of one point, W^2
  double flux = 0.0;            // W, without onlyFlux
  double pointCost = 0.0;       // rays
  double startDensity = 1.0;
  double onlyFlux = 0.0, onlyVariance = 0.0;  // light that only photons find: W, and W^2 a photon
  double allFlux() const { return flux + onlyFlux; }
};

// Sizes of typical samples of both pilots, and startDensity(), where nothing is known of a pool.
struct Samples {
  double photons = 0.0, points = 0.0, startDensity = 1.0;
};

// Both pilots in a pool. `flux` is the average over its VPLs, weighted by inverse variance.
struct Comparison {
  Pooled photons, points;
  double flux = 0.0;
};

// Size of a typical sample, variance / flux. Where the pool has few samples, flux^2 / variance, it
// is drawn towards that of the pool around it: rare bright samples show only where many VPLs are
// pooled.
double sampleSize(const Pooled& here, double around) {
  if (!(here.flux > 0.0 && here.variance > 0.0)) return around;
  const double samples = here.flux * here.flux / here.variance;
  return (here.flux + kTrusted * around) / (samples + kTrusted);
}

Comparison compare(std::span<const uint32_t> pool, const Pilots& pilots, const Samples& anywhere) {
  Pooled photons, points;
  for (const uint32_t k : pool) {
    photons.flux += pilots.byPhotons[k].flux;
    photons.variance += pilots.byPhotons[k].variance;
    points.flux += pilots.byPaths[k].flux;
    points.variance += pilots.byPaths[k].variance;
  }
  photons.variance += missedSquared(photons, anywhere.photons);
  points.variance += missedSquared(points, anywhere.points);
  // Light that one pilot found and the other missed comes to the other in samples as rare and
  // bright as one in all that it drew here.
  const double difference = photons.flux - points.flux;
  const double noise = kMaxDeviations * std::sqrt(photons.variance + points.variance);
  const double missedByPoints = std::max(0.0, difference - noise);
  const double missedByPhotons = std::max(0.0, -difference - noise);
  points.variance += missedByPoints * missedByPoints;
  photons.variance += missedByPhotons * missedByPhotons;
  const double sum = photons.variance + points.variance;
  const double flux =
      sum > 0.0 ? (photons.flux * points.variance + points.flux * photons.variance) / sum : 0.0;
  return {photons, points, flux / static_cast<double>(pool.size())};
}

// Samples of either pilot come like photons: the variance of a sum is its flux times the size of a
// typical sample. Both estimate one flux, so their variances compare as the sizes do.
VplStatistics poolPilots(std::span<const uint32_t> wide, const Pilots& pilots,
                         const Samples& anywhere) {
  const auto near = wide.first(std::min(kPool, wide.size()));
  const Comparison here = compare(near, pilots, anywhere), around = compare(wide, pilots, anywhere);
  const double photons = sampleSize(here.photons, sampleSize(around.photons, anywhere.photons));
  const double points = sampleSize(here.points, sampleSize(around.points, anywhere.points));
  // A pilot may have missed one sample of the pool.
  const double flux = here.flux + std::min(photons, points) / static_cast<double>(near.size());
  VplStatistics v;
  v.flux = here.flux;
  v.photonVariance = photons * flux * pilots.photons;
  v.pointVariance = points * flux * pilots.points;
  v.startDensity = startDensity(wide, pilots.byPhotons, anywhere.startDensity);
  const double each = 1.0 / static_cast<double>(near.size());
  for (const uint32_t k : near) {
    v.pointCost += pilots.pointCost[k] * each;
    v.onlyFlux += pilots.byPhotons[k].onlyFlux * each;
    v.onlyVariance += pilots.byPhotons[k].onlyVariance * each * pilots.photons;
  }
  return v;
}

std::vector<VplStatistics> poolAllPilots(const VplTable& vpls, const Pilots& pilots) {
  const KdTree tree(vpls.position);
  // A pilot whose photons reached no VPL tells only their power.
  const double found = meanSample(pilots.byPhotons);
  std::vector<uint32_t> all(vpls.size());
  std::iota(all.begin(), all.end(), 0u);
  const Samples anywhere{found > 0.0 ? found : pilots.photonPower, meanSample(pilots.byPaths),
                         startDensity(all, pilots.byPhotons, 1.0)};
  std::vector<VplStatistics> statistics(vpls.size());
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
      statistics[i] = poolPilots(pool, pilots, anywhere);
    }
  });
  return statistics;
}

// Neyman's allocation of points to VPLs beside P photons. The error of VPL i is
// w_i / (P / v_i + n_i / u_i). It falls alike everywhere for its cost c_i n_i where
//
//   n_i = max(0, a_i s - b_i P),     a_i = sqrt(w_i u_i / c_i),     b_i = u_i / v_i
//
// and the scale s, one over the root of Lagrange's multiplier, is the same for all VPLs.
class PointAllocation {
 public:
  explicit PointAllocation(std::vector<VplStatistics> statistics)
      : vpls_(std::move(statistics)),
        weight_(vpls_.size()),
        perScale_(vpls_.size()),
        perPhoton_(vpls_.size()) {
    double mean = 0.0;
    for (const VplStatistics& v : vpls_) mean += v.allFlux() / static_cast<double>(vpls_.size());
    for (size_t i = 0; i < vpls_.size(); ++i) {
      const VplStatistics& v = vpls_[i];
      weight_[i] = 1.0 / std::max(v.allFlux() + kMinFlux * mean, 1e-300);
      if (!(v.pointVariance > 0.0)) continue;
      perScale_[i] = std::sqrt(weight_[i] * v.pointVariance / v.pointCost);
      perPhoton_[i] = v.pointVariance / v.photonVariance;
      if (const double from = perPhoton_[i] / perScale_[i]; std::isfinite(from))
        steps_.push_back({from, v.pointCost * perScale_[i], v.pointCost * perPhoton_[i]});
    }
    std::ranges::sort(steps_, {}, &Step::from);
    for (size_t k = 1; k < steps_.size(); ++k)
      steps_[k].perScale += steps_[k - 1].perScale, steps_[k].perPhoton += steps_[k - 1].perPhoton;
  }

  // Number of points of VPL i.
  double at(size_t i, double photons, double scale) const {
    return std::max(0.0, perScale_[i] * scale - perPhoton_[i] * photons);
  }
  double costAt(double photons, double scale) const {
    double sum = 0.0;
    for (size_t i = 0; i < vpls_.size(); ++i) sum += vpls_[i].pointCost * at(i, photons, scale);
    return sum;
  }
  // The scale for which all points together have this cost.
  double scaleFor(double photons, double cost) const {
    const auto cheaper =
        [&](size_t k) {  // whether the VPLs before the k-th cost less, where it begins
          const double scale = photons * steps_[k].from;
          return steps_[k - 1].perScale * scale - steps_[k - 1].perPhoton * photons < cost;
        };
    if (steps_.empty() || !(cost > 0.0)) return 0.0;
    const auto later = std::views::iota(size_t{1}, steps_.size());
    const Step& last =
        steps_[static_cast<size_t>(std::ranges::partition_point(later, cheaper) - later.begin())];
    return (cost + last.perPhoton * photons) / last.perScale;
  }
  double weightedVarianceAt(double photons, double scale) const {
    double sum = 0.0;
    for (size_t i = 0; i < vpls_.size(); ++i) sum += weight_[i] * variance(i, photons, scale);
    return sum;
  }
  double relativeErrorAt(double photons, double scale, const IrradianceProbes& probes) const {
    std::vector<double> flux, variances;
    for (size_t i = 0; i < vpls_.size(); ++i) {
      flux.push_back(vpls_[i].allFlux());
      variances.push_back(variance(i, photons, scale));
    }
    return probes.relativeError(flux, variances);
  }
  // Split::misRatio of VPL i. Photons that start with density g vary g times less than by
  // power, so that their weight by inverse variance is g / (g + misRatio).
  double misRatio(size_t i, double photons, double points) const {
    const VplStatistics& v = vpls_[i];
    if (!(points > 0.0)) return 0.0;
    // Both ends divide by it as a float, which must be neither 0 nor infinite.
    return std::clamp(v.startDensity * points * v.photonVariance / (photons * v.pointVariance),
                      1e-30, 1e30);
  }

 private:
  double variance(size_t i, double photons, double scale) const {
    const VplStatistics& v = vpls_[i];
    const double known = photons / v.photonVariance;
    const double shared =
        1.0 / (v.pointVariance > 0.0 ? known + at(i, photons, scale) / v.pointVariance : known);
    return shared + v.onlyVariance / photons;
  }

  // A VPL gets points from the scale `from` P on. Sums over it and those that get points earlier:
  // of c a and of c b.
  struct Step {
    double from, perScale, perPhoton;
  };

  std::vector<VplStatistics> vpls_;
  std::vector<double> weight_, perScale_, perPhoton_;  // w, a and b of each VPL
  std::vector<Step> steps_;                            // in the order in which VPLs get points
};

// Number of photons, the scale that allots points, and the weighted sum of variances that results.
struct Allocation {
  double photons = 0.0, scale = 0.0, weightedVariance = INFINITY;
};

Allocation bestAllocation(const PointAllocation& points, double photonCost, double cost) {
  Allocation best;
  for (int part = 1; part <= kParts; ++part) {
    const double ofPhotons = cost * part / kParts, photons = ofPhotons / photonCost;
    const double scale = part == kParts ? 0.0 : points.scaleFor(photons, cost - ofPhotons);
    const double variance = points.weightedVarianceAt(photons, scale);
    if (variance < best.weightedVariance) best = {photons, scale, variance};
  }
  return best;
}

// Lowers the cost step by step, as long as the predicted error stays below that of the budget.
Allocation smallestAllocation(const PointAllocation& points, const VplTable& vpls,
                              const Accelerator& accel, double photonCost,
                              const WorkBudget& budget) {
  Allocation best = bestAllocation(points, photonCost, budget.cost);
  if (!(budget.error > 0.0)) return best;
  const IrradianceProbes probes(vpls, accel);
  double cost = budget.cost;
  for (int step = 0; step < kSteps; ++step) {
    cost *= kStep;
    const Allocation less = bestAllocation(points, photonCost, cost);
    if (!(points.relativeErrorAt(less.photons, less.scale, probes) <= budget.error)) break;
    best = less;
  }
  return best;
}

}  // namespace

Split photonsAlone(uint64_t photons, size_t vpls) {
  Split split{std::max<uint64_t>(1, photons), std::vector<uint64_t>(vpls),
              std::vector<float>(vpls)};
  split.withoutPaths = true;
  return split;
}

Split splitWork(const VplTable& vpls, const Accelerator& accel, const Pilots& pilots,
                const WorkBudget& budget) {
  const PointAllocation points(poolAllPilots(vpls, pilots));
  const Allocation best = smallestAllocation(points, vpls, accel, pilots.photonCost, budget);
  Split split;
  split.photons = std::max<uint64_t>(1, static_cast<uint64_t>(std::llround(best.photons)));
  split.points.resize(vpls.size());
  split.misRatio.resize(vpls.size());
  const auto photons = static_cast<double>(split.photons);
  split.cost = photons * pilots.photonCost + points.costAt(photons, best.scale);
  split.costShare = std::min(1.0, split.cost / budget.cost);
  for (size_t i = 0; i < vpls.size(); ++i) {
    split.points[i] = static_cast<uint64_t>(std::llround(points.at(i, photons, best.scale)));
    split.misRatio[i] =
        static_cast<float>(points.misRatio(i, photons, static_cast<double>(split.points[i])));
  }
  return split;
}

}  // namespace bnvpl::methods::estimate::both
