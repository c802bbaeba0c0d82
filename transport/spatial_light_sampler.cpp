#include "transport/spatial_light_sampler.h"

#include <algorithm>

#include "core/parallel.h"
#include "spatial/facing.h"
#include "spatial/morton_order.h"
#include "transport/strata_pilot.h"

namespace bnvpl {

namespace {

// Min number of points that share a distribution; more points share one if there would be more than
// kMaxGroups groups.
constexpr size_t kPointsOfGroup = 8, kMaxGroups = 512;
// Max number of strata. Tiles of the film have more, because each place here has few rays.
constexpr size_t kStrata = 256;
constexpr size_t kRaysEach = 16;  // pilot rays of each stratum

// Neighbouring points whose normals have the same dominant axis and sign.
struct Group {
  size_t begin, end;  // range in the order
  uint32_t facing;
};

std::vector<Group> groupsOf(std::span<const uint32_t> order, std::span<const Vec3> normals) {
  const size_t most =
      std::max(kPointsOfGroup, (order.size() + kMaxGroups - 1) / std::max<size_t>(1, kMaxGroups));
  std::vector<Group> groups;
  for (size_t k = 0; k < order.size(); ++k) {
    const uint32_t facing = facingOf(normals[order[k]]);
    if (groups.empty() || groups.back().facing != facing ||
        groups.back().end - groups.back().begin == most)
      groups.push_back({k, k, facing});
    ++groups.back().end;
  }
  return groups;
}

}  // namespace

SpatialLightSampler::SpatialLightSampler(const Accelerator& accel, const LightSet& lights,
                                         std::span<const Vec3> points,
                                         std::span<const Vec3> normals,
                                         std::span<const float> radii, uint64_t key,
                                         const ProgressFn& progress)
    : strata_(lights, kStrata), groupOf_(points.size()) {
  if (strata_.size() < 2 || points.empty()) return;
  regions_ = RegionGrid(points, normals, radii);
  std::vector<uint32_t> order = mortonOrder(points);
  std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    return facingOf(normals[a]) < facingOf(normals[b]);
  });
  const std::vector<Group> groups = groupsOf(order, normals);
  const auto phase = progress.beginPhase("light visibility, groups of VPLs", groups.size());
  std::vector<StrataValues> found(groups.size());
  parallelFor(groups.size(), 1, [&](size_t g) {
    std::vector<SurfacePoint> at;
    for (size_t k = groups[g].begin; k < groups[g].end; ++k) {
      groupOf_[order[k]] = static_cast<uint32_t>(g);
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
  groups_.resize(groups.size());
  parallelFor(groups.size(), 16, [&](size_t g) {
    PooledStrata sum(strata_.size());
    for (size_t k = g > 0 ? g - 1 : 0; k < std::min(groups.size(), g + 2); ++k) {
      if (groups[k].facing == groups[g].facing) sum.add(found[k]);
    }
    groups_[g] = sum.distribution();
  });
  everywhere_ = meanOf(groups_, strata_.size());
}

LearnedStrata SpatialLightSampler::at(Vec3 position, Vec3 normal) const {
  if (groups_.empty()) return {};
  const uint32_t point = regions_.at(position, normal);
  return {&strata_, point == UINT32_MAX ? StrataDistribution{} : groups_[groupOf_[point]].seen(),
          everywhere_.seen()};
}

}  // namespace bnvpl
