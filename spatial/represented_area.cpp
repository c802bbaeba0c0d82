#include "spatial/represented_area.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/sampling.h"
#include "spatial/all_neighbours.h"
#include "spatial/compatible_surface.h"
#include "spatial/packed_disks.h"

namespace bnvpl {
namespace {

// The distance within which `count` neighbours lie on a compatible surface.
struct NeighbourRadius {
  float distanceSquared = 0.0f;
  unsigned count = 0;
};

// `nearest` is sorted by distance and may contain `self`, which is skipped.
NeighbourRadius radiusOnSurface(std::span<const Vec3> position, std::span<const Vec3> normal,
                                uint32_t self, const std::vector<Neighbour>& nearest, unsigned k) {
  const size_t kth = std::min<size_t>(k, nearest.size() - 1);
  const float tolerance = kPlaneFactor * std::sqrt(nearest[kth].distanceSquared);
  NeighbourRadius radius;
  for (const Neighbour& n : nearest) {
    if (n.index == self || !compatibleSurfaces(position[self], normal[self], position[n.index],
                                               normal[n.index], tolerance)) {
      continue;
    }
    radius = {n.distanceSquared, radius.count + 1};
    if (radius.count == k) break;
  }
  return radius;
}

// find(self, count, nearest) finds the points nearest to point `self`.
template <typename Find>
NeighbourRadius findRadius(std::span<const Vec3> position, std::span<const Vec3> normal,
                           uint32_t self, unsigned k, Find& find, std::vector<Neighbour>& nearest) {
  // On flat surfaces nearly all neighbours qualify, so that a short query usually suffices. Its
  // result is a prefix of that of the long query.
  find(self, k + k / 8 + 1, nearest);
  NeighbourRadius radius = radiusOnSurface(position, normal, self, nearest, k);
  if (radius.count == k) return radius;
  find(self, 3 * size_t{k} + 1, nearest);
  radius = radiusOnSurface(position, normal, self, nearest, k);
  if (radius.count > 0) return radius;
  const auto others = static_cast<unsigned>(nearest.size() - 1);
  return {nearest.back().distanceSquared, std::max(1u, others)};
}

// makeFind() gives a `find` for a range of points.
template <typename MakeFind>
std::vector<float> sharesOf(std::span<const Vec3> position, std::span<const Vec3> normal,
                            unsigned k, const MakeFind& makeFind, std::span<const uint32_t> rows,
                            const ProgressFn& progress) {
  Bounds bounds;
  for (const Vec3 p : position) bounds.extend(p);
  const float smallest = 1e-6f * bounds.diagonal();
  const size_t count = rows.empty() ? position.size() : rows.size();
  if (!(smallest > 0.0f)) {
    const float distance2 = position.empty() ? 0.0f : lengthSquared(position[0]);
    return std::vector<float>(count, distance2 > 0.0f ? distance2 : 1.0f);
  }

  std::vector<float> share(count);
  parallelRanges(count, 256, [&](size_t begin, size_t end) {
    std::vector<Neighbour> nearest;
    auto find = makeFind();
    for (size_t i = begin; i < end; ++i) {
      const auto self = rows.empty() ? static_cast<uint32_t>(i) : rows[i];
      const NeighbourRadius radius =
          findRadius(position, normal, self, std::max(1u, k), find, nearest);
      const float distanceSquared = std::max(radius.distanceSquared, smallest * smallest);
      share[i] = kPi * distanceSquared / static_cast<float>(radius.count);
    }
    if (progress) progress(end - begin);
  });
  return share;
}

}  // namespace

std::vector<float> representedAreas(std::span<const Vec3> position, std::span<const Vec3> normal,
                                    unsigned k, const KdTree& tree, std::span<const uint32_t> rows,
                                    const ProgressFn& progress) {
  const auto find = [&](uint32_t self, size_t count, std::vector<Neighbour>& nearest) {
    tree.nearest(position[self], count, nearest);
  };
  return sharesOf(
      position, normal, k, [&] { return find; }, rows, progress);
}

std::vector<float> representedAreas(std::span<const Vec3> position, std::span<const Vec3> normal,
                                    unsigned k, const ProgressFn& progress) {
  const AllNeighbours points(position);
  const auto makeFind = [&points] {
    // Short and long queries have a state each, so that a long one does not widen the next short
    // one.
    return [&points, few = AllNeighbours::Query{}, many = AllNeighbours::Query{}, least = SIZE_MAX](
               uint32_t self, size_t count, std::vector<Neighbour>& nearest) mutable {
      least = std::min(least, count);
      points.nearest(self, count, count == least ? few : many, nearest);
    };
  };
  return sharesOf(position, normal, k, makeFind, {}, progress);
}

RepresentedRadii representedRadii(std::span<const Vec3> position, std::span<const Vec3> normal) {
  RepresentedRadii result;
  for (const float share : representedAreas(position, normal, kAreaNeighbours)) {
    result.area += double{share};
    result.radius.push_back(packedDiskRadius(share));
  }
  const auto count = static_cast<double>(std::max<size_t>(1, position.size()));
  result.rMax = packedDiskRadius(result.area, count);
  return result;
}

}  // namespace bnvpl
