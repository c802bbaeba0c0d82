#include "transport/direct_light/spatial_light_sampler.h"

#include <algorithm>

#include "core/parallel.h"
#include "spatial/facing.h"
#include "spatial/morton_order.h"
#include "transport/direct_light/strata_pilot.h"

namespace bnvpl {

namespace {

// Max number of points that share a distribution; more share one where there would be more than
// some kMaxClusters clusters.
constexpr size_t kMaxPoints = 8, kMaxClusters = 512;
// Max number of strata. Tiles of the film have more, because each place here has few rays.
constexpr size_t kStrata = 256;
constexpr size_t kRaysEach = 16;  // pilot rays of each stratum

// Neighbouring points whose normals have the same dominant axis and sign.
struct Cluster {
  size_t begin, end;  // range in the order
  uint32_t facing;
};

std::vector<Cluster> clustersOf(std::span<const uint32_t> order, std::span<const Vec3> normals) {
  const size_t maxPoints = std::max(kMaxPoints, (order.size() + kMaxClusters - 1) / kMaxClusters);
  std::vector<Cluster> clusters;
  for (size_t k = 0; k < order.size(); ++k) {
    const uint32_t facing = facingOf(normals[order[k]]);
    if (clusters.empty() || clusters.back().facing != facing ||
        clusters.back().end - clusters.back().begin == maxPoints)
      clusters.push_back({k, k, facing});
    ++clusters.back().end;
  }
  return clusters;
}

}  // namespace

SpatialLightSampler::SpatialLightSampler(const Accelerator& accel, const LightSet& lights,
                                         std::span<const Vec3> points,
                                         std::span<const Vec3> normals,
                                         std::span<const float> radii, uint64_t key,
                                         const ProgressFn& progress)
    : strata_(lights, kStrata), distributionOf_(points.size()) {
  if (strata_.size() < 2 || points.empty()) return;
  regions_ = RegionGrid(points, normals, radii);
  std::vector<uint32_t> order = mortonOrder(points);
  std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    return facingOf(normals[a]) < facingOf(normals[b]);
  });
  const std::vector<Cluster> clusters = clustersOf(order, normals);
  const auto phase = progress.beginPhase("light visibility, groups of VPLs", clusters.size());
  std::vector<StrataValues> found(clusters.size());
  parallelFor(clusters.size(), 1, [&](size_t g) {
    std::vector<SurfacePoint> at;
    for (size_t k = clusters[g].begin; k < clusters[g].end; ++k) {
      distributionOf_[order[k]] = static_cast<uint32_t>(g);
      SurfacePoint& p = at.emplace_back();
      p.position = points[order[k]];
      p.ng = p.ns = p.wo = normals[order[k]];
    }
    std::vector<Bsdf> vertices;
    for (const SurfacePoint& p : at) vertices.emplace_back(p, Vec3(1.0f));
    Rng rng(key, g);
    found[g] = estimateStrata(accel, lights, strata_, vertices, kRaysEach, rng);
    if (progress) progress(1);
  });
  distributions_.resize(clusters.size());
  parallelFor(clusters.size(), 16, [&](size_t g) {
    PooledStrata sum(strata_.size());
    for (size_t k = g > 0 ? g - 1 : 0; k < std::min(clusters.size(), g + 2); ++k) {
      if (clusters[k].facing == clusters[g].facing) sum.add(found[k]);
    }
    distributions_[g] = sum.distribution();
  });
  everywhere_ = meanOf(distributions_, strata_.size());
}

LearnedStrata SpatialLightSampler::at(Vec3 position, Vec3 normal) const {
  if (distributions_.empty()) return {};
  const uint32_t point = regions_.at(position, normal);
  return {
      &strata_,
      point == UINT32_MAX ? StrataDistribution{} : distributions_[distributionOf_[point]].seen(),
      everywhere_.seen()};
}

}  // namespace bnvpl
